//! The telegrams on the line, and what the pendant shows.

use super::Run;

/// One direction of the line. No payload on this line begins with a control character.
#[derive(Default)]
struct Direction {
    block: Vec<u8>,
    acknowledgements: usize,
    negative: usize,
}

impl Direction {
    /// Takes a byte; a payload when its block ends.
    fn take(&mut self, byte: u8) -> Option<Vec<u8>> {
        if self.block.is_empty() {
            match byte {
                0x02 => return None,
                0x10 => self.acknowledgements += 1,
                0x15 => self.negative += 1,
                _ => self.block.push(byte),
            }
            return None;
        }
        self.block.push(byte);
        let [payload @ .., 0x10, 0x03, _] = self.block.as_slice() else {
            return None;
        };
        assert_eq!(self.block.iter().fold(0, |bcc, byte| bcc ^ byte), 0);
        assert!(!payload.contains(&0x10));
        let payload = payload.to_vec();
        self.block.clear();
        Some(payload)
    }
}

/// Telegrams in their order: true from the control.
fn telegrams(log: &str) -> (Vec<(bool, Vec<u8>)>, [Direction; 2]) {
    let (mut telegrams, mut before) = (Vec::new(), -1.0);
    let mut directions = [Direction::default(), Direction::default()];
    for line in log.lines() {
        let mut words = line.split(' ');
        let time: f64 = words.next().unwrap().parse().unwrap();
        assert!(time >= before, "{line}");
        before = time;
        let from_control = match words.next() {
            Some(">") => true,
            Some("<") => false,
            other => panic!("{other:?}"),
        };
        for word in words {
            assert_eq!(word.len(), 2);
            let byte = u8::from_str_radix(word, 16).unwrap();
            let payload = directions[usize::from(!from_control)].take(byte);
            telegrams.extend(payload.map(|payload| (from_control, payload)));
        }
    }
    (telegrams, directions)
}

#[test]
fn the_line_carries_3964r_in_order() {
    let run = Run::of("pt", &[]);
    let (telegrams, [control, unit]) = telegrams(&run.read("line.log"));
    let of = |from_control: bool| telegrams.iter().filter(move |it| it.0 == from_control);
    // One for STX and one for the block.
    assert_eq!(unit.acknowledgements, 2 * of(true).count());
    assert_eq!(control.acknowledgements, 2 * of(false).count());
    // Nobody answers the first request: the pendant has no power yet.
    assert_eq!((control.negative, unit.negative), (1, 0));
    assert_eq!(telegrams[0], (true, vec![0x23]));
    assert_eq!(telegrams[1], (false, vec![0x30, 0x41, 0x51]));

    let mut display = [[' '; 16]; 8];
    let (mut status_due, mut answer_due) = (false, false);
    let (mut seen_change, mut seen_busy, mut moves) = (false, false, 0);
    for (from_control, payload) in &telegrams {
        match (from_control, payload.as_slice()) {
            (true, other) => {
                assert!(!status_due && !answer_due, "{other:02X?} before a reply");
                status_due = other == [0x23];
                answer_due = other[0] == 0x6C;
                if answer_due {
                    show(&mut display, &other[1..]);
                }
            }
            (false, [0x6C, answer]) => {
                assert!(answer_due && *answer == 0x31);
                answer_due = false;
            }
            (false, [_, _, _]) => status_due = false,
            (false, [key]) => moves += usize::from(*key == 0x34),
            (false, other) => panic!("{other:02X?}"),
        }
        let line = |line: usize| display[line].iter().collect::<String>();
        // The change from the platform file's poses.
        seen_change |= line(1).ends_with("+35.000 mm") && line(6).ends_with("+2.500000deg");
        seen_busy |= line(0).ends_with("LOCATOR  2 BUSY");
    }
    assert!(seen_change && seen_busy && moves == 1);
    let last: String = display[7].iter().collect();
    assert_eq!(last.trim_end(), "DONE");

    let total = ["status_requests", "leds", "display_blocks"];
    let sent: f64 = total
        .map(|name| run.number(&format!("/telegrams/{name}")))
        .iter()
        .sum();
    // One request was never delivered.
    let count = f64::from(u32::try_from(of(true).count()).unwrap());
    assert!((sent - run.number("/telegrams/failed") - count).abs() < 0.5);
}

/// Characters behind a place, as in `27 line column`.
fn show(display: &mut [[char; 16]; 8], mut commands: &[u8]) {
    let (mut line, mut column) = (0, 0);
    while let [first, rest @ ..] = commands {
        commands = rest;
        match first {
            0x27 => {
                (line, column) = (usize::from(rest[0] - 0x30), usize::from(rest[1] - 0x30));
                commands = &rest[2..];
            }
            code => {
                display[line][column] = char::from(code - 0x60);
                column += 1;
            }
        }
    }
}
