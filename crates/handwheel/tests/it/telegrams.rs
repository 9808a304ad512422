//! The telegrams of the manuals, byte by byte.

use handwheel::{
    AreaNumber, Cell, Column, Command, DecodeError, EncodeError, Font, Key, LcdAnswer, LcdBlock,
    LcdCommand, LcdError, Led, LedState, Line, MAX_COMMAND, MAX_REPORT, Model, Position, Rect,
    Report, RotarySwitch, Status, Text, TextNumber,
};
use proto3964r::{Check, frame};

/// The block of a payload as it stands on the line, without STX.
fn on_the_line(payload: &[u8]) -> Vec<u8> {
    let mut body = [0; 300];
    let len = frame::encode(payload, Check::Bcc, &mut body).unwrap();
    body[..len].to_vec()
}

fn command(command: Command<'_>) -> Vec<u8> {
    let mut buffer = [0; MAX_COMMAND];
    let telegram = command.clone().encode(Model::Hbls, &mut buffer).unwrap();
    assert_eq!(Command::decode(Model::Hbls, telegram), Ok(command));
    on_the_line(telegram)
}

fn report(report: Report) -> Vec<u8> {
    let mut buffer = [0; MAX_REPORT];
    let telegram = report.encode(Model::Hbls, &mut buffer).unwrap();
    assert_eq!(Report::decode(Model::Hbls, telegram), Ok(report));
    on_the_line(telegram)
}

fn lcd(commands: &[LcdCommand<'_>]) -> Vec<u8> {
    let mut block = LcdBlock::new(Model::Hbls);
    for &command in commands {
        block.push(command).unwrap();
    }
    assert!(block.commands().eq(commands.iter().map(|&it| Ok(it))));
    on_the_line(block.as_bytes())
}

fn cell(line: u8, column: u8) -> Cell {
    let (line, column) = (Line::new(line).unwrap(), Column::new(column).unwrap());
    Cell { line, column }
}

#[test]
fn lamps_and_status_request() {
    let led = |led, state| command(Command::Led { led, state });
    let seven = Led::new(7).ok();
    // Printed, with its BCC.
    assert_eq!(led(seven, LedState::On), [0x37, 0x10, 0x03, 0x24]);
    assert_eq!(led(seven, LedState::Off), [0x47, 0x10, 0x03, 0x54]);
    assert_eq!(led(seven, LedState::Flashing), [0x57, 0x10, 0x03, 0x44]);
    assert_eq!(led(None, LedState::Off)[0], 0x40);
    let request = command(Command::StatusRequest);
    assert_eq!(request, [0x23, 0x10, 0x03, 0x30]);
}

#[test]
fn keys_switches_and_status() {
    let key = |number| Key::new(number).ok();
    let at = |number| Position::new(number).unwrap();
    let (w1, w2) = (at(1), at(1));
    assert_eq!(report(Report::Key(key(1))), [0x31, 0x10, 0x03, 0x22]);
    assert_eq!(report(Report::Key(key(11))), [0x3B, 0x10, 0x03, 0x28]);
    assert_eq!(report(Report::Key(None)), [0x30, 0x10, 0x03, 0x23]);
    let (switch, position) = (RotarySwitch::W1, at(12));
    let turned = report(Report::RotarySwitch { switch, position });
    assert_eq!(turned, [0x4C, 0x10, 0x03, 0x5F]);
    let status = Status::Hbls { key: None, w1, w2 };
    let reply = report(Report::Status(status));
    assert_eq!(reply, [0x30, 0x41, 0x51, 0x10, 0x03, 0x33]);
    let answer = report(Report::Lcd(LcdAnswer::Done));
    assert_eq!(answer, [0x6C, 0x31, 0x10, 0x03, 0x4E]);
}

#[test]
fn display_blocks() {
    let euchner = Text::new("Euchner").unwrap();
    let codes = [0xA5, 0xD5, 0xC3, 0xC8, 0xCE, 0xC5, 0xD2];
    assert!(euchner.codes().eq(codes));
    // Printed, with its BCC.
    let printed = lcd(&[LcdCommand::Text(euchner)]);
    assert_eq!(printed[..8], [&[0x6C][..], &codes].concat());
    assert_eq!(printed[8..], [0x10, 0x03, 0xDD]);

    let end = [0x10, 0x03];
    let with_bcc = |payload: &[u8], bcc: u8| [payload, &end, &[bcc]].concat();
    let five = TextNumber::new(5).unwrap();
    assert_eq!(lcd(&[LcdCommand::Home]), with_bcc(&[0x6C, 0x25], 0x5A));
    let to_end = lcd(&[LcdCommand::DeleteToLineEnd]);
    assert_eq!(to_end, with_bcc(&[0x6C, 0x29], 0x5A ^ 0x25 ^ 0x29));
    let define = LcdCommand::DefineText {
        number: five,
        font: None,
        cell: cell(4, 0),
        text: euchner,
    };
    let kept = [&[0x6C, 0x48, 0x35, 0x34, 0x30][..], &codes, &[0x0A]].concat();
    assert_eq!(lcd(&[define]), with_bcc(&kept, 0xAE));
    let show = lcd(&[LcdCommand::ShowText(five)]);
    assert_eq!(show, with_bcc(&[0x6C, 0x49, 0x35], 0x03));
    let flashing = [
        LcdCommand::Flash(true),
        LcdCommand::ShowText(five),
        LcdCommand::Flash(false),
    ];
    let shown = with_bcc(&[0x6C, 0x42, 0x49, 0x35, 0x43], 0x02);
    assert_eq!(lcd(&flashing), shown);
    let number = AreaNumber::new(22).unwrap();
    let (start, end) = (cell(4, 0), cell(6, 10));
    let rect = Rect { start, end };
    let area = with_bcc(&[0x6C, 0x4A, 0x46, 0x34, 0x30, 0x36, 0x3A], 0x7B);
    assert_eq!(lcd(&[LcdCommand::DefineArea { number, rect }]), area);
    // Line first, whatever the words around the example say.
    let (start, end) = (cell(2, 3), cell(3, 6));
    let delete = lcd(&[LcdCommand::DeleteRect(Rect { start, end })]);
    assert_eq!(delete[1..6], [0x2C, 0x32, 0x33, 0x33, 0x36]);
    let effects = [LcdCommand::ClearArea, LcdCommand::NormalArea].map(|effect| effect(number));
    assert_eq!(lcd(&effects)[1..5], [0x4B, 0x46, 0x4F, 0x46]);
}

#[test]
fn last_numbers() {
    let show = LcdCommand::ShowText(TextNumber::MAX);
    assert_eq!(lcd(&[show])[2], 0xF8);
    let clear = LcdCommand::ClearArea(AreaNumber::MAX);
    assert_eq!(lcd(&[clear])[2], 0x50);
    let error = TextNumber::new(201).unwrap_err();
    assert_eq!(error.to_string(), "text 201 is not within 1..=200");
}

#[test]
fn display_blocks_have_a_largest_length() {
    for model in [Model::Hbls, Model::Hbas] {
        let max = model.max_lcd_block();
        let mut telegram = vec![0xA0; max + 1];
        telegram[0] = 0x6C;
        let Ok(Command::Lcd(commands)) = Command::decode(model, &telegram[..max]) else {
            panic!("{model:?}");
        };
        assert_eq!(commands.size_hint(), (1, Some(max - 1)));
        let mut buffer = [0; MAX_COMMAND];
        let same = Command::Lcd(commands).encode(model, &mut buffer);
        assert_eq!(same, Ok(&telegram[..max]));
        let refused = Command::decode(model, &telegram);
        assert_eq!(refused, Err(DecodeError::Length { len: max + 1 }));
    }
    let block = LcdBlock::new(Model::Hbas);
    assert_eq!(block.commands().size_hint(), (0, Some(0)));
    let model = Model::Hbls;
    let mut buffer = [0; MAX_COMMAND];
    let foreign = Command::Lcd(block.commands()).encode(model, &mut buffer);
    assert_eq!(foreign, Err(EncodeError::Model { model }));
}

#[test]
fn hbas() {
    let mut buffer = [0; MAX_REPORT];
    let status = Status::Hbas {
        key: Key::new(11).ok(),
        lcd: LcdAnswer::Done,
    };
    let telegram = Report::Status(status).encode(Model::Hbas, &mut buffer);
    let telegram = telegram.unwrap();
    assert_eq!(on_the_line(telegram), [0x3B, 0x31, 0x10, 0x03, 0x19]);
    assert_eq!(
        Report::decode(Model::Hbas, telegram),
        Ok(Report::Status(status))
    );
    // The same byte, another meaning.
    let key = Report::Key(Key::new(17).ok());
    assert_eq!(Report::decode(Model::Hbas, &[0x41]), Ok(key));
    let (switch, position) = (RotarySwitch::W1, Position::MIN);
    let turned = Report::RotarySwitch { switch, position };
    assert_eq!(Report::decode(Model::Hbls, &[0x41]), Ok(turned));
    let model = Model::Hbas;
    assert_eq!(
        turned.encode(model, &mut buffer),
        Err(EncodeError::Model { model })
    );
    assert!(key.encode(Model::Hbls, &mut buffer).is_err());

    let mut block = LcdBlock::new(Model::Hbas);
    let define = |font| LcdCommand::DefineText {
        number: TextNumber::MIN,
        font,
        cell: cell(0, 0),
        text: Text::new("A").unwrap(),
    };
    assert_eq!(block.push(define(None)), Err(LcdError::Font { model }));
    block.push(define(Some(Font::Large))).unwrap();
    assert_eq!(block.as_bytes(), [0x6C, 0x48, 0x31, 0x51, 0x30, 0x30, 0xA1]);
}

#[test]
fn refusals_name_the_byte() {
    let refused = |telegram: &[u8]| Report::decode(Model::Hbls, telegram).unwrap_err();
    assert_eq!(refused(&[]), DecodeError::Length { len: 0 });
    let (index, byte) = (1, 0x35);
    assert_eq!(refused(&[0x6C, 0x35]), DecodeError::Unknown { index, byte });
    let (index, byte) = (2, 0x41);
    assert_eq!(
        refused(&[0x30, 0x41, 0x41]),
        DecodeError::Unknown { index, byte }
    );
    assert!(Command::decode(Model::Hbls, &[0x3D]).is_err());
    assert!(Command::decode(Model::Hbas, &[0x31]).is_err());

    let mut block = LcdBlock::new(Model::Hbls);
    let long = "0123456789".repeat(12);
    block
        .push(LcdCommand::Text(Text::new(&long).unwrap()))
        .unwrap();
    let before = block;
    let more = LcdCommand::Text(Text::new("12345678").unwrap());
    let (len, max) = (129, 128);
    assert_eq!(block.push(more), Err(LcdError::Full { len, max }));
    assert_eq!(block, before);
    let error = Text::new("1°").unwrap_err().to_string();
    assert_eq!(error, "byte 1 of the text, C2h, is not printable ASCII");
    let (capacity, len) = (2, 3);
    let status = Status::Hbls {
        key: None,
        w1: Position::MIN,
        w2: Position::MAX,
    };
    assert_eq!(
        Report::Status(status).encode(Model::Hbls, &mut [0; 2]),
        Err(EncodeError::NoRoom { len, capacity })
    );

    let read = |bytes: &'static [u8]| {
        let Ok(Command::Lcd(commands)) = Command::decode(Model::Hbls, bytes) else {
            panic!()
        };
        let mut last = None;
        for command in commands {
            last = Some(command);
        }
        last.unwrap().unwrap_err().to_string()
    };
    assert_eq!(
        read(&[0x6C, 0x25, 0x7F]),
        "byte 2 of the block: 7Fh is no command"
    );
    assert_eq!(
        read(&[0x6C, 0x27, 0x38]),
        "byte 2 of the block: line 8 is not within 0..=7"
    );
    assert_eq!(
        read(&[0x6C, 0x27, 0x37]),
        "the block ends after 3 bytes, within a command"
    );
    assert!(read(&[0x6C, 0x2C, 0x32, 0x30, 0x31, 0x30]).contains("before it starts"));
}

/// Every telegram of up to three bytes: as many as there are keys, positions and answers mean
/// something, and each of them is written as it was read.
#[test]
fn no_other_report_is_understood() {
    let readable = |model: Model, telegram: &[u8]| {
        let report = Report::decode(model, telegram);
        if let Ok(report) = report {
            let mut buffer = [0; MAX_REPORT];
            assert_eq!(report.encode(model, &mut buffer), Ok(telegram));
        }
        usize::from(report.is_ok())
    };
    let bytes = || 0..=u8::MAX;
    for (model, counts) in [
        (Model::Hbls, [13 + 12 + 12, 4, 13 * 12 * 12]),
        (Model::Hbas, [21, 21 * 6, 0]),
    ] {
        let (mut one, mut two, mut three) = (0, 0, 0);
        for a in bytes() {
            one += readable(model, &[a]);
            for b in bytes() {
                two += readable(model, &[a, b]);
                three += bytes().map(|c| readable(model, &[a, b, c])).sum::<usize>();
            }
        }
        assert_eq!([one, two, three], counts);
    }
}
