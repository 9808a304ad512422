//! How programs write G-code: words, order, digits, what they leave out and what they put around
//! it.

use core::fmt::Write as _;

use super::drawings::Part;

/// A program's name, and a drawing as it writes it.
pub(crate) type Writer = (&'static str, fn(&[Part]) -> String);

pub(crate) const WRITERS: [Writer; 10] = [
    ("vector-drawing", vector_drawing),
    ("laser", laser),
    ("laser-relative", laser_relative),
    ("post-processor", post_processor),
    ("parametric-cad", parametric_cad),
    ("slicer", slicer),
    ("sign-maker", sign_maker),
    ("circuit-board", circuit_board),
    ("sender-with-checksums", sender),
    ("by-hand", by_hand),
];

/// Digits of a number without zeros at its end, but with its point.
fn short(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let text = text.trim_end_matches('0').to_owned();
    if text == "-0." { "0.".to_owned() } else { text }
}

/// Each part with the place where it begins; arcs as `G2` and `G3` or as lines.
fn each(parts: &[Part], has_arcs: bool, mut write: impl FnMut([f64; 2], &Part)) {
    let mut from = [0.0; 2];
    for part in parts {
        match part {
            Part::Arc { .. } if !has_arcs => {
                for to in part.points(from) {
                    write(from, &Part::Line(to));
                    from = to;
                }
            }
            _ => write(from, part),
        }
        from = part.to();
    }
}

/// Six decimals, comments in brackets, the pen's depth in each line.
fn vector_drawing(parts: &[Part]) -> String {
    let mut text = String::from(
        "%\n(Header)\n(Generated from a drawing)\nM3\n(Header end.)\nG21 (All units in mm)\n",
    );
    each(parts, true, |from, part| {
        let [x, y] = part.to();
        let _ = match part {
            Part::Rapid(_) => writeln!(
                text,
                "G00 Z5.000000\nG00 X{x:.6} Y{y:.6}\nG01 Z-0.125000 F100.0(Penetrate)"
            ),
            Part::Line(_) => writeln!(text, "G01 X{x:.6} Y{y:.6} Z-0.125000 F1200.000000"),
            Part::Arc { .. } => {
                let (word, [i, j]) = part.arc(from).unwrap();
                let word = word.replace('G', "G0");
                writeln!(
                    text,
                    "{word} X{x:.6} Y{y:.6} Z-0.125000 I{i:.6} J{j:.6} F1200.000000"
                )
            }
        };
    });
    text + "G00 Z5.000000\n(Footer)\nM5\nM2\n%\n"
}

/// Modal, without blanks, power in each first line of a cut.
fn laser(parts: &[Part]) -> String {
    let mut text = String::from(
        "; GRBL device profile, absolute coords\n\nG00 G17 G40 G21 G54\nG90\nM4\n; Cut @ 20 mm/sec, 40% power\nM8\n",
    );
    let mut is_first = true;
    each(parts, true, |from, part| {
        let [x, y] = part.to();
        let rest = if is_first { "S400F1200" } else { "" };
        let _ = match part {
            Part::Rapid(_) => writeln!(text, "G0 X{x:.3}Y{y:.3}"),
            Part::Line(_) => writeln!(text, "G1 X{x:.3}Y{y:.3}{rest}"),
            Part::Arc { .. } => {
                let (word, [i, j]) = part.arc(from).unwrap();
                writeln!(text, "{word} X{x:.3}Y{y:.3}I{i:.3}J{j:.3}{rest}")
            }
        };
        is_first = matches!(part, Part::Rapid(_));
    });
    text + "M9\nG1 S0\nM5\nG90\nM2\n"
}

/// Relative moves, of which the digits left out are carried to the next.
fn laser_relative(parts: &[Part]) -> String {
    let mut text =
        String::from("; GRBL device profile, relative coords\nG00 G17 G40 G21 G54\nG91\nM4 S0\n");
    let mut at = [0_i32; 2];
    each(parts, false, |_, part| {
        let rounded = part
            .to()
            .map(|x| format!("{:.0}", x * 1000.0).parse::<i32>().unwrap());
        let [x, y] = [rounded[0] - at[0], rounded[1] - at[1]].map(|by| f64::from(by) / 1000.0);
        at = rounded;
        let _ = match part {
            Part::Rapid(_) => writeln!(text, "G0X{x}Y{y}"),
            _ => writeln!(text, "G1X{x}Y{y}F1200S300"),
        };
    });
    text + "M5\nG90\nM30\n"
}

/// Numbered blocks, words left out that do not change, a point and no zeros behind it.
fn post_processor(parts: &[Part]) -> String {
    let mut text = String::from("%\nO1001 (PART)\n(T1 D=3. CR=0. - ZMIN=-1. - FLAT END MILL)\n");
    let mut number = 0;
    let mut block = |words: &str| {
        number += 5;
        let _ = writeln!(text, "N{number} {words}");
    };
    for words in ["G90 G94", "G17", "G21", "T1 M6", "S8000 M3", "G54", "M8"] {
        block(words);
    }
    let mut before = String::new();
    each(parts, true, |from, part| {
        let mut words = String::new();
        let word = match part {
            Part::Rapid(_) => "G0",
            Part::Line(_) => "G1",
            Part::Arc { .. } => part.arc(from).unwrap().0,
        };
        if word != before {
            let _ = write!(words, "{word} ");
            word.clone_into(&mut before);
        }
        for (axis, (from, to)) in ['X', 'Y'].into_iter().zip(from.into_iter().zip(part.to())) {
            if short(from, 4) != short(to, 4) {
                let _ = write!(words, "{axis}{} ", short(to, 4));
            }
        }
        if let Some((_, offset)) = part.arc(from) {
            for (word, by) in ['I', 'J'].into_iter().zip(offset) {
                if by.abs() > 5e-5 {
                    let _ = write!(words, "{word}{} ", short(by, 4));
                }
            }
        }
        if word != "G0" {
            words += "F1200.";
        }
        block(words.trim_end());
    });
    for words in ["M9", "M5", "M30"] {
        block(words);
    }
    text + "%\n"
}

/// Operations with their names, each axis in each line.
fn parametric_cad(parts: &[Part]) -> String {
    let mut text = String::from(
        "(Exported by a CAD program)\n(Post Processor: linuxcnc)\n(Begin preamble)\nG17 G54 G40 G49 G80 G90\nG21\n(Begin operation: Profile)\n(Path: Profile)\n",
    );
    each(parts, true, |from, part| {
        let [x, y] = part.to();
        let _ = match part {
            Part::Rapid(_) => writeln!(
                text,
                "G0 Z5.000\nG0 X{x:.3} Y{y:.3} Z5.000\nG1 X{x:.3} Y{y:.3} Z-1.000 F300.000"
            ),
            Part::Line(_) => writeln!(text, "G1 X{x:.3} Y{y:.3} Z-1.000 F1200.000"),
            Part::Arc { .. } => {
                let (word, [i, j]) = part.arc(from).unwrap();
                writeln!(
                    text,
                    "{word} X{x:.3} Y{y:.3} Z-1.000 I{i:.3} J{j:.3} K0.000 F1200.000"
                )
            }
        };
    });
    text + "(Finish operation: Profile)\n(Begin postamble)\nM05\nG17 G54 G90 G80 G40\nM2\n"
}

/// Lines only, filament in each, the feed in a line of its own.
fn slicer(parts: &[Part]) -> String {
    let mut text = String::from(
        "; generated by a slicer\nM73 P0 R1\nM201 X1000 Y1000\nM104 S215 ; set temperature\nG21 ; set units to millimeters\nG90 ; use absolute coordinates\nM83 ; use relative distances for extrusion\n;LAYER_CHANGE\n;Z:0.2\nG1 Z.2 F720\n;TYPE:External perimeter\n",
    );
    each(parts, false, |from, part| {
        let [x, y] = part.to();
        let length = (x - from[0]).hypot(y - from[1]);
        let _ = match part {
            Part::Rapid(_) => writeln!(
                text,
                "G1 E-.8 F2100\nG0 X{x:.3} Y{y:.3}\nG1 E.8 F2100\nG1 F1200"
            ),
            _ => writeln!(text, "G1 X{x:.3} Y{y:.3} E{:.5}", length * 0.033),
        };
    });
    text + "M107\nM104 S0 ; turn off temperature\nM84 ; disable motors\n"
}

/// Words without blanks, the feed in each line, a tool and its speed at the start.
fn sign_maker(parts: &[Part]) -> String {
    let mut text =
        String::from("( Sign )\n( Tool : 1 )\nT1M6\nG17\nG21\nG90\nG0Z20.320\nS12000M3\n");
    each(parts, true, |from, part| {
        let [x, y] = part.to();
        let _ = match part {
            Part::Rapid(_) => writeln!(text, "G0X{x:.3}Y{y:.3}Z5.080\nG1Z-1.000F500.0"),
            Part::Line(_) => writeln!(text, "G1X{x:.3}Y{y:.3}Z-1.000F1200.0"),
            Part::Arc { .. } => {
                let (word, [i, j]) = part.arc(from).unwrap();
                writeln!(text, "{word}X{x:.3}Y{y:.3}I{i:.3}J{j:.3}F1200.0")
            }
        };
    });
    text + "G0Z20.320\nM5\nM30\n"
}

/// Inches, and lines only.
fn circuit_board(parts: &[Part]) -> String {
    let mut text = String::from(
        "( isolation of a board )\nG94 ( Millimeters/inches per minute feed rate. )\nG20 ( Units == INCHES. )\nG90 ( Absolute coordinates. )\nS10000 ( RPM spindle speed. )\nM3 ( Spindle on. )\n",
    );
    each(parts, false, |_, part| {
        let [x, y] = part.to().map(|mm| mm / 25.4);
        let _ = match part {
            Part::Rapid(_) => writeln!(
                text,
                "G00 Z0.07874\nG00 X{x:.6} Y{y:.6} ( rapid move to begin. )\nG01 Z-0.00500 F20.00000"
            ),
            _ => writeln!(text, "G01 X{x:.6} Y{y:.6} F{:.5}", 1200.0 / 25.4),
        };
    });
    text + "M5 ( Spindle off. )\nM2 ( Program end. )\n"
}

/// Numbered lines, each with the exclusive or of its bytes.
fn sender(parts: &[Part]) -> String {
    let mut text = String::new();
    let mut number = 0;
    let mut send = |words: String| {
        let line = format!("N{number} {words}");
        let sum = line.bytes().fold(0, |sum, byte| sum ^ byte);
        let _ = writeln!(text, "{line}*{sum}");
        number += 1;
    };
    send("M110".to_owned());
    send("G21".to_owned());
    send("G90".to_owned());
    each(parts, false, |_, part| {
        let [x, y] = part.to();
        send(match part {
            Part::Rapid(_) => format!("G0 X{x:.3} Y{y:.3} F6000"),
            _ => format!("G1 X{x:.3} Y{y:.3} F1200"),
        });
    });
    text
}

/// Small letters, few digits where few do, lines ended as on an old system, radii for arcs.
fn by_hand(parts: &[Part]) -> String {
    let mut text = String::from("g21 g90\r\n\r\n");
    each(parts, true, |from, part| {
        let [x, y] = part.to().map(|mm| short(mm, 4));
        let _ = match part {
            Part::Rapid(_) => write!(text, "g0 x{x} y{y}\r\n"),
            Part::Line(_) => write!(text, "g1 x{x} y{y} f1200\r\n"),
            Part::Arc { to, .. } => {
                let (word, [i, j]) = part.arc(from).unwrap();
                let (word, radius) = (word.to_lowercase(), i.hypot(j));
                let apart = (to[0] - from[0]).hypot(to[1] - from[1]);
                // Rounded, a half turn's radius must not be less than half of its chord.
                let radius = radius.max(apart * 0.5);
                write!(text, "{word} x{x} y{y} r{} f1200\r\n", short(radius, 4))
            }
        };
    });
    text
}
