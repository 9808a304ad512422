//! Round trips both ways, and the wheel.

use core::time::Duration;

use handwheel::{
    AreaNumber, Cell, Column, Command, Font, Key, LcdAnswer, LcdBlock, LcdCommand, LcdError, Led,
    LedState, Line, MAX_COMMAND, MAX_REPORT, Model, Position, Rect, Report, RotarySwitch, Status,
    Text, TextNumber, WheelError, WheelQuantiser, WheelSampler,
};
use proptest::prelude::*;

fn model() -> impl Strategy<Value = Model> {
    prop::sample::select(vec![Model::Hbls, Model::Hbas])
}

fn report() -> impl Strategy<Value = (Model, Report)> {
    let keys = |most: u8| prop::option::of((1..=most).prop_map(|key| Key::new(key).unwrap()));
    let position = || (1u8..=12).prop_map(|position| Position::new(position).unwrap());
    let switch = prop::sample::select(vec![RotarySwitch::W1, RotarySwitch::W2]);
    let common = [
        LcdAnswer::Done,
        LcdAnswer::NoSuchText,
        LcdAnswer::NoSuchArea,
        LcdAnswer::BadParameter,
    ];
    let late = [LcdAnswer::TooManyParameters, LcdAnswer::AreaOverlap];
    let answer = prop::sample::select(common.to_vec());
    let hbas_answer = prop::sample::select([&common[..], &late].concat());
    let hbls =
        prop_oneof![
            keys(12).prop_map(Report::Key),
            (switch, position())
                .prop_map(|(switch, position)| Report::RotarySwitch { switch, position }),
            (keys(12), position(), position())
                .prop_map(|(key, w1, w2)| Report::Status(Status::Hbls { key, w1, w2 })),
            answer.prop_map(Report::Lcd),
        ];
    let hbas = prop_oneof![
        keys(20).prop_map(Report::Key),
        (keys(20), hbas_answer).prop_map(|(key, lcd)| Report::Status(Status::Hbas { key, lcd })),
    ];
    prop_oneof![
        hbls.prop_map(|report| (Model::Hbls, report)),
        hbas.prop_map(|report| (Model::Hbas, report)),
    ]
}

fn cell() -> impl Strategy<Value = Cell> {
    (0u8..8, 0u8..16).prop_map(|(line, column)| Cell {
        line: Line::new(line).unwrap(),
        column: Column::new(column).unwrap(),
    })
}

fn rect() -> impl Strategy<Value = Rect> {
    (cell(), cell()).prop_map(|(a, b)| Rect {
        start: Cell {
            line: a.line.min(b.line),
            column: a.column.min(b.column),
        },
        end: Cell {
            line: a.line.max(b.line),
            column: a.column.max(b.column),
        },
    })
}

/// Everything but characters; kept texts are cut out of these.
const LETTERS: &str = "The quick brown fox, {jumps} ~ over 1 lazy dog?";

fn lcd_command(model: Model) -> impl Strategy<Value = LcdCommand<'static>> {
    use LcdCommand as C;
    let plain = [
        C::Next,
        C::Previous,
        C::Down,
        C::Up,
        C::Home,
        C::LineStart,
        C::Delete,
        C::DeleteToLineEnd,
        C::DeleteToDisplayEnd,
        C::DeleteAll,
        C::Inverse(true),
        C::Inverse(false),
        C::Flash(true),
        C::Flash(false),
    ];
    let effects = [
        C::ClearArea,
        C::InverseArea,
        C::FlashArea,
        C::InverseFlashArea,
        C::NormalArea,
    ];
    let text = |most: usize| {
        (0..LETTERS.len(), 1..=most).prop_map(|(from, len)| {
            let end = (from + len).min(LETTERS.len());
            Text::new(&LETTERS[from..end]).unwrap()
        })
    };
    let number = || (1u8..=200).prop_map(|number| TextNumber::new(number).unwrap());
    let area = || (1u8..=32).prop_map(|number| AreaNumber::new(number).unwrap());
    let font = (model == Model::Hbas).then_some(Font::Small);
    prop_oneof![
        prop::sample::select(plain.to_vec()),
        cell().prop_map(C::Goto),
        rect().prop_map(C::DeleteRect),
        number().prop_map(C::ShowText),
        text(40).prop_map(C::Text),
        (area(), prop::sample::select(effects.to_vec()))
            .prop_map(|(number, effect)| effect(number)),
        (area(), rect()).prop_map(|(number, rect)| C::DefineArea { number, rect }),
        (number(), cell(), text(30)).prop_map(move |(number, cell, text)| C::DefineText {
            number,
            font,
            cell,
            text
        }),
    ]
}

fn block() -> impl Strategy<Value = (Model, Vec<LcdCommand<'static>>)> {
    model().prop_flat_map(|model| {
        let commands = prop::collection::vec(lcd_command(model), 0..20);
        (Just(model), commands)
    })
}

fn is_text(command: &LcdCommand<'_>, model: Model) -> bool {
    let kept = model == Model::Hbas && matches!(command, LcdCommand::DefineText { .. });
    kept || matches!(command, LcdCommand::Text(_))
}

proptest! {
    #[test]
    fn reports_round_trip((model, report) in report()) {
        let mut buffer = [0; MAX_REPORT];
        let telegram = report.encode(model, &mut buffer).unwrap();
        prop_assert_eq!(Report::decode(model, telegram), Ok(report));
    }

    #[test]
    fn leds_round_trip(led in prop::option::of(1u8..=12), state in 0usize..3) {
        let state = [LedState::On, LedState::Off, LedState::Flashing][state];
        let led = led.map(|led| Led::new(led).unwrap());
        let command = Command::Led { led, state };
        let mut buffer = [0; 1];
        let telegram = command.clone().encode(Model::Hbls, &mut buffer).unwrap();
        prop_assert_eq!(Command::decode(Model::Hbls, telegram), Ok(command));
    }

    /// What fits comes back; what does not leaves the block as it was.
    #[test]
    fn display_blocks_round_trip((model, commands) in block()) {
        let (mut block, mut kept): (_, Vec<LcdCommand<'_>>) = (LcdBlock::new(model), Vec::new());
        for command in commands {
            // Characters behind characters are one text when they are read back.
            if kept.last().is_some_and(|last| is_text(last, model)) && is_text(&command, model)
                && matches!(command, LcdCommand::Text(_)) {
                continue;
            }
            let before = block;
            match block.push(command) {
                Ok(()) => kept.push(command),
                Err(error) => {
                    let full = matches!(error, LcdError::Full { len, max } if len > max);
                    prop_assert!(full && block == before);
                }
            }
        }
        prop_assert!(block.as_bytes().len() <= model.max_lcd_block());
        // No control character of the procedure but as the number that it cannot be.
        prop_assert!(!block.as_bytes().contains(&0x10));
        let read: Result<Vec<_>, _> = block.commands().collect();
        prop_assert_eq!(read, Ok(kept));
    }

    /// Whatever is read is written as the same bytes.
    #[test]
    fn what_decodes_encodes(
        model in model(),
        telegram in prop_oneof![
            prop::collection::vec(any::<u8>(), 0..5),
            prop::collection::vec(0x20u8..0x60, 1..40).prop_map(|mut bytes| {
                bytes[0] = 0x6C;
                bytes
            }),
        ],
    ) {
        if let Ok(report) = Report::decode(model, &telegram) {
            let mut buffer = [0; MAX_REPORT];
            prop_assert_eq!(report.encode(model, &mut buffer), Ok(&telegram[..]));
        }
        if let Ok(command) = Command::decode(model, &telegram) {
            let mut buffer = [0; MAX_COMMAND];
            prop_assert_eq!(command.clone().encode(model, &mut buffer), Ok(&telegram[..]));
            if let Command::Lcd(commands) = command {
                let (mut block, mut whole) = (LcdBlock::new(model), true);
                for command in commands {
                    whole &= command.is_ok_and(|command| block.push(command).is_ok());
                }
                prop_assert!(!whole || block.as_bytes() == telegram);
            }
        }
    }

    #[test]
    fn wheel_is_odd_monotone_idempotent_and_bounded(
        (max, bins) in (1u32..=100_000).prop_flat_map(|max| {
            let most = u16::try_from(max).unwrap_or(u16::MAX);
            (Just(max), 1..=most)
        }),
        a in any::<i32>(),
        b in -120_000..=120_000i32,
        full in any::<u32>(),
    ) {
        let wheel = WheelQuantiser::new(max, bins).unwrap();
        for n in [a, b] {
            let (level, counts) = (wheel.level(n), wheel.counts(n));
            if let Some(opposite) = n.checked_neg() {
                prop_assert_eq!(wheel.level(opposite), -level);
                prop_assert_eq!(wheel.counts(opposite), -counts);
                prop_assert_eq!(wheel.speed(opposite, full), -wheel.speed(n, full));
            }
            prop_assert!(level.unsigned_abs() <= 2 * u64::from(bins));
            prop_assert!(counts.unsigned_abs() <= u64::from(max));
            prop_assert!(wheel.speed(n, full).unsigned_abs() <= u64::from(full));
            prop_assert_eq!(wheel.counts(i32::try_from(counts).unwrap()), counts);
            prop_assert_eq!(wheel.level(i32::try_from(counts).unwrap()), level);
            // The formula itself, in exact fractions: 2 m f(n) / max.
            let size = u64::from(n.unsigned_abs());
            let (m, most) = (u64::from(bins), u64::from(max));
            let expected = match size {
                0 => 0,
                _ if size >= most => 2 * m,
                _ => 2 * (size * m / most) + 1,
            };
            prop_assert_eq!(level.unsigned_abs(), expected);
        }
        let (low, high) = (a.min(b), a.max(b));
        prop_assert!(wheel.level(low) <= wheel.level(high));
        prop_assert!(wheel.speed(low, full) <= wheel.speed(high, full));
    }
}

#[test]
fn wheel_of_the_paper() {
    let wheel = WheelQuantiser::new(100, 10).unwrap();
    let of = |n| wheel.counts(n);
    assert_eq!([of(0), of(1), of(5), of(9), of(10)], [0, 5, 5, 5, 15]);
    // The printed formula gives -15 here, and nothing at all for 100.
    assert_eq!([of(-5), of(99), of(100), of(-101)], [-5, 95, 100, -100]);
    assert_eq!((wheel.level(i32::MIN), wheel.bins()), (-20, 10));
    assert_eq!(WheelQuantiser::new(0, 1), Err(WheelError::NoRange));
    let (bins, max) = (11, 10);
    let refused = WheelQuantiser::new(max, bins);
    assert_eq!(refused, Err(WheelError::Bins { bins, max }));
    assert!(WheelQuantiser::new(10, 0).is_err());
}

#[test]
fn samples() {
    let at = Duration::from_millis;
    let mut wheel = WheelSampler::new(at(0), u32::MAX - 9);
    assert_eq!(wheel.sample(at(199), 0), None);
    assert_eq!(wheel.sample(at(200), 20), Some(30));
    // Half a second late: the mean speed.
    assert_eq!(wheel.due(), at(400));
    assert_eq!(wheel.sample(at(900), 20u32.wrapping_sub(35)), Some(-10));
    assert_eq!(wheel.sample(at(1100), 20u32.wrapping_sub(35)), Some(0));
}
