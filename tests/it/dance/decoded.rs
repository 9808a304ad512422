//! What the header and the dump of a dance say: each motor's steps, by both.

use std::collections::HashMap;

/// The `#define`s and the bytes of a header.
pub(crate) fn header(text: &str) -> (HashMap<&str, usize>, Vec<u8>) {
    let defines = text.lines().filter_map(|line| {
        let words: Vec<_> = line.split_whitespace().collect();
        match words[..] {
            ["#define", name, value] => Some((name.strip_prefix("DANCE_")?, value.parse().ok()?)),
            _ => None,
        }
    });
    let table = text.split_once('{').unwrap().1.split_once('}').unwrap().0;
    let bytes = table.split(',').map(|number| match number.trim() {
        hex if hex.starts_with("0x") => u8::from_str_radix(&hex[2..], 16).unwrap(),
        signed => signed.parse::<i16>().unwrap().to_le_bytes()[0],
    });
    (defines.collect(), bytes.collect())
}

pub(crate) fn frames(text: &str) -> Vec<[i8; 8]> {
    let (defines, bytes) = header(text);
    assert_eq!(bytes.len(), defines["BYTES"]);
    assert_eq!((defines["MOTORS"], defines["FRAME_TICKS"]), (8, 200));
    assert_eq!((defines["TICK_US"], defines["THRESHOLD"]), (1000, 600));
    let mut bytes = bytes.into_iter();
    let mut frames = Vec::new();
    let mut frame = [0; 8];
    while let Some(first) = bytes.next() {
        let (count, mask) = match defines["PACKING"] {
            0 => {
                frame[0] = first.cast_signed();
                (1, 0xFE)
            }
            1 => (first, 0xFF),
            _ => (first, bytes.next().unwrap()),
        };
        for (motor, speed) in frame.iter_mut().enumerate() {
            if mask >> motor & 1 == 1 {
                *speed = bytes.next().unwrap().cast_signed();
            }
        }
        frames.extend(vec![frame; count.into()]);
    }
    assert_eq!(frames.len(), defines["FRAMES"]);
    frames
}

/// Each motor's steps: the tick, from 1, and the position after it.
pub(crate) fn steps(frames: &[[i8; 8]], law: &str) -> [Vec<(u64, i64)>; 8] {
    core::array::from_fn(|motor| {
        let (mut sum, mut position, mut tick) = (0_i32, 0, 0);
        let mut steps = Vec::new();
        for frame in frames {
            let speed = i32::from(frame[motor]);
            for _ in 0..200 {
                tick += 1;
                sum += if law == "signed" { speed } else { speed.abs() };
                if sum.abs() >= 600 {
                    let forward = if law == "signed" { sum > 0 } else { speed > 0 };
                    sum -= match law {
                        "reset" => sum,
                        _ if sum < 0 => -600,
                        _ => 600,
                    };
                    position += if forward { 1 } else { -1 };
                    steps.push((tick, position));
                }
            }
        }
        steps
    })
}

/// The wires of the dump: data, then strobes, then motors.
pub(crate) fn wires(head: &str) -> HashMap<&str, usize> {
    let declared = head.lines().filter_map(|line| {
        let words: Vec<_> = line.split_whitespace().collect();
        let ["$var", "wire", _, id, name, "$end"] = words[..] else {
            return None;
        };
        let number = |start| Some(name.strip_prefix(start)?.parse::<usize>().unwrap());
        let strobe = number("strobe").map(|number| 1 + number);
        let motor = number("motor").map(|number| 9 + number);
        Some((id, strobe.or(motor).unwrap_or(0)))
    });
    declared.collect()
}

/// What the dump says: each motor's steps as [`steps`] has them. The data must be stable while a
/// strobe is high, only one strobe may be, and the motors must be what the latches follow.
pub(crate) fn decoded(dump: &str) -> [Vec<(u64, i64)>; 8] {
    const HALF_STEPS: [u8; 8] = [1, 3, 2, 6, 4, 12, 8, 9];
    let (head, body) = dump.split_once("$enddefinitions $end\n").unwrap();
    let wires = wires(head);
    assert_eq!(wires.len(), 17);
    let mut levels = [0_u8; 17];
    let mut latches = [0; 8];
    let mut at: [Option<i64>; 8] = [None; 8];
    let mut steps: [Vec<(u64, i64)>; 8] = Default::default();
    let mut last = None;
    for stamp in format!("\n{body}").split("\n#").skip(1) {
        let mut lines = stamp.lines();
        let ns: u64 = lines.next().unwrap().parse().unwrap();
        assert!(last < Some(ns), "time goes back at {ns}");
        last = Some(ns);
        let before = levels;
        for line in lines.filter(|line| !line.starts_with('$')) {
            let (value, id) = match line.strip_prefix('b') {
                Some(vector) => vector.split_once(' ').unwrap(),
                None => line.split_at(1),
            };
            levels[wires[id]] = u8::from_str_radix(value, 2).unwrap();
        }
        let open = (0..8).filter(|motor| before[1 + motor] == 1 || levels[1 + motor] == 1);
        let open: Vec<usize> = open.collect();
        assert!(open.len() < 2, "two strobes at {ns}");
        if let [motor] = open[..] {
            assert_eq!(before[0], levels[0], "data under a strobe at {ns}");
            latches[motor] = levels[0];
        }
        assert_eq!(levels[9..], latches, "{ns}");
        for motor in (0..8).filter(|motor| latches[*motor] != 0) {
            let place = HALF_STEPS
                .iter()
                .position(|nibble| *nibble == latches[motor]);
            let place = i64::try_from(place.expect("no phase")).unwrap();
            // The first phase comes before the first tick.
            let old = at[motor].unwrap_or(0);
            let position = old + (place - old + 4).rem_euclid(8) - 4;
            if position != old {
                assert_eq!((position - old).abs(), 1, "a jump at {ns}");
                assert!(ns % 1_000_000 < 100_000, "a step between ticks at {ns}");
                steps[motor].push((ns / 1_000_000, position));
            }
            at[motor] = Some(position);
        }
    }
    assert_eq!(levels[1..9], [0; 8], "a strobe stays high");
    assert!(at.iter().all(Option::is_some), "a motor without current");
    steps
}
