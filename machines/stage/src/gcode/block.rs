//! A block of G-code, sorted: codes, values of motions, and what is passed over.

use anyhow::{Result, bail, ensure};

use super::codes::{self, Code, Mode};
use super::words::Word;
use machine_sim::input::Notes;

/// Beyond it, no curve is the stage's.
const LARGEST_MM: f64 = 100_000.0;

/// What a code that takes the axes can have without a number, or as its own.
const FLAGS: &str = "XYZABCEORW";

/// One line of a program, with nothing left over.
pub(crate) struct Block<'a> {
    pub(crate) line: usize,
    /// By their names.
    pub(crate) codes: Vec<(String, Code)>,
    /// What is neither a code nor one's own nor passed over.
    words: Vec<&'a Word>,
}

impl<'a> Block<'a> {
    pub(crate) fn new(line: usize, words: &'a [Word], notes: &mut Notes) -> Result<Self> {
        let mut block = Self {
            line,
            codes: Vec::new(),
            words: Vec::new(),
        };
        let mut own = String::new();
        for word in words.iter().filter(|word| "GM".contains(word.letter)) {
            own += block.push_code(word, words, notes)?;
        }
        // The axis words are those of a code that says no motion.
        let takes_axes = block.has_code(Code::Reference) || block.has_code(Code::Position);
        for word in words.iter().filter(|word| !"GM".contains(word.letter)) {
            let is_again = block.words.iter().any(|other| other.letter == word.letter);
            ensure!(!is_again, "{word}: a second {}", word.letter);
            if own.contains(word.letter) {
                continue;
            }
            // Beside a code that takes the axes, some letters are flags of it.
            if !takes_axes || !FLAGS.contains(word.letter) {
                word.value()?;
                if let Some(note) = passed_over(word, words)? {
                    notes.add(line, word.letter, note);
                    continue;
                }
            }
            check_size(word)?;
            block.words.push(word);
        }
        Ok(block)
    }

    /// Takes a code; returns the letters of the line that are its own.
    fn push_code(
        &mut self,
        word: &Word,
        words: &[Word],
        notes: &mut Notes,
    ) -> Result<&'static str> {
        let tenths = word.tenths()?;
        let mut name = name(word.letter, tenths);
        let code = codes::meaning(word.letter, tenths);
        let names = |letters: &str| words.iter().any(|it| letters.contains(it.letter));
        let (own, note) = match code {
            // Beside a G-code the words are not those of an M-code.
            Code::PassedOver(passed) if word.letter == 'M' && names("G") => ("", Some(passed.note)),
            Code::PassedOver(passed) => {
                let (letters, how) = passed.unless;
                ensure!(!names(letters), "{name}: {how}");
                (passed.own, Some(passed.note))
            }
            Code::Refused(reason) => bail!("{name}: {reason}"),
            Code::Dwell => (dwell(&name, words)?, Some(codes::DWELLS)),
            Code::SecondReference => {
                let is_upright = names("Z") && !names("XY");
                ensure!(
                    is_upright,
                    "{name}: the stage has no second reference point"
                );
                ("ABCZ", Some(codes::AXES))
            }
            // G54.1 P1: one of many.
            Code::WorkOffset => {
                let p = words.iter().find(|word| word.letter == 'P');
                name.extend(p.map(|p| format!(" {p}")));
                ("P", None)
            }
            _ => ("", None),
        };
        if let Some(note) = note {
            notes.add(self.line, name.clone(), note);
        }
        self.check_group(&name, code)?;
        self.codes.push((name, code));
        Ok(own)
    }

    /// Two codes of one group contradict each other; to say a mode twice does no harm.
    fn check_group(&self, name: &str, code: Code) -> Result<()> {
        let Some(one_of) = group(code) else {
            return Ok(());
        };
        for (other_name, other) in &self.codes {
            let is_again = group(*other) == Some(one_of);
            let is_same_mode = other_name == name && one_of != MOTION;
            ensure!(!is_again || is_same_mode, "{name}: a second {one_of}");
        }
        Ok(())
    }

    fn has_code_that(&self, wanted: impl Fn(Code) -> bool) -> bool {
        self.codes.iter().any(|(_, code)| wanted(*code))
    }

    pub(crate) fn has_code(&self, wanted: Code) -> bool {
        self.has_code_that(|code| code == wanted)
    }

    pub(crate) fn has_motion(&self) -> bool {
        self.has_code_that(|code| matches!(code, Code::Motion(_)))
    }

    pub(crate) fn has_arc(&self) -> bool {
        self.has_code_that(|code| matches!(code, Code::Motion(Mode::Circular(_))))
    }

    /// Whether it sets a local zero, G52.
    pub(crate) fn is_local(&self) -> bool {
        self.codes.iter().any(|(name, _)| name == "G52")
    }

    /// Whether there is a word with one of these letters.
    pub(crate) fn has(&self, letters: &str) -> bool {
        self.words.iter().any(|word| letters.contains(word.letter))
    }

    /// Whether any coordinate is named.
    pub(crate) fn has_axes(&self) -> bool {
        self.has("XYZIJKR")
    }

    /// Whether no axis is named, by which all are meant.
    pub(crate) fn names_no_axis(&self) -> bool {
        !self.has("XYZABCE")
    }

    /// Whether axes are named, and neither X nor Y.
    pub(crate) fn is_upright(&self) -> bool {
        !self.names_no_axis() && !self.has("XY")
    }

    /// The number after a letter, in the program's unit.
    pub(crate) fn value(&self, letter: char) -> Option<f64> {
        let word = self.words.iter().find(|word| word.letter == letter)?;
        word.number
    }

    /// Refuses words that the motion has no use for.
    pub(crate) fn check_letters(&self, mode: Option<Mode>) -> Result<()> {
        let is_arc = matches!(mode, Some(Mode::Circular(_)));
        let is_cycle = matches!(mode, Some(Mode::Cycle(_)));
        for word in &self.words {
            let is_one = word.number == Some(1.0);
            match word.letter {
                'K' | 'L' if is_cycle => ensure!(is_one, "{word}: a cycle that is repeated"),
                'I' | 'J' | 'K' | 'R' if mode.is_some() && !is_arc && !is_cycle => {
                    bail!("{} on a straight motion", word.letter)
                }
                'P' if is_arc => ensure!(is_one, "{word}: an arc of more than one turn"),
                'P' | 'Q' if is_cycle => {}
                'P' | 'Q' | 'L' => bail!("{word}: no word of this stage"),
                _ => {}
            }
        }
        Ok(())
    }

    /// Notes the words of an axis that is not there.
    pub(crate) fn note_axes(&self, notes: &mut Notes) {
        for word in self.words.iter().filter(|word| "ZK".contains(word.letter)) {
            notes.add(self.line, word.letter, codes::AXES);
        }
    }
}

/// The letters of a dwell: X and U to some machines where neither P nor S is there.
fn dwell(name: &str, words: &[Word]) -> Result<&'static str> {
    let names = |letters: &str| words.iter().any(|word| letters.contains(word.letter));
    if names("PS") || !names("XU") {
        return Ok("PS");
    }
    let moves = words.iter().any(|word| {
        let tenths = word.tenths();
        let code = tenths.map(|tenths| codes::meaning(word.letter, tenths));
        word.letter == 'G' && matches!(code, Ok(Code::Motion(_)))
    });
    ensure!(
        !moves,
        "{name}: X is its time to some machines, a motion to others"
    );
    Ok("XU")
}

/// The name of a code, as G90.1 for 901.
pub(crate) fn name(letter: char, tenths: u32) -> String {
    match tenths % 10 {
        0 => format!("{letter}{}", tenths / 10),
        tenth => format!("{letter}{}.{tenth}", tenths / 10),
    }
}

const MOTION: &str = "motion";

/// Codes of which one line can have one.
const fn group(code: Code) -> Option<&'static str> {
    match code {
        Code::Motion(_) | Code::Reference | Code::SecondReference | Code::Position => Some(MOTION),
        Code::Plane(_) => Some("plane"),
        Code::Unit(_) => Some("unit"),
        Code::Relative(_) => Some("distance mode"),
        Code::AbsoluteCentres(_) => Some("mode of centres"),
        Code::WorkOffset => Some("work offset"),
        Code::Dwell
        | Code::FeedPerMinute
        | Code::CyclesEnd
        | Code::MachineCoordinates
        | Code::End
        | Code::PassedOver(_)
        | Code::Refused(_) => None,
    }
}

/// What is noted of a word that moves neither X nor Y; nothing for a word of motions.
fn passed_over(word: &Word, block: &[Word]) -> Result<Option<&'static str>> {
    Ok(Some(match word.letter {
        'A' | 'B' | 'C' | 'W' => codes::AXES,
        'E' => codes::EXTRUDER,
        'S' => codes::SPINDLE,
        'T' | 'D' | 'H' => codes::TOOLS,
        'O' if block.len() == 1 => codes::PROGRAM_NUMBER,
        'O' => bail!("{word}: {}", codes::SUBPROGRAM),
        'U' | 'V' => bail!("{word}: X or Y to some machines, an axis of its own to others"),
        'X' | 'Y' | 'Z' | 'I' | 'J' | 'K' | 'R' | 'F' | 'P' | 'Q' | 'L' => return Ok(None),
        _ => bail!("{word}: no word of this stage"),
    }))
}

fn check_size(word: &Word) -> Result<()> {
    let is_length = "XYZIJKR".contains(word.letter);
    let is_small = word.number.is_none_or(|value| value.abs() <= LARGEST_MM);
    ensure!(!is_length || is_small, "{word}: above {LARGEST_MM}");
    Ok(())
}
