//! What the codes of G-code mean to a stage that has two axes and nothing else.

use pulse_interp::Turn;

/// What the next axis words do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mode {
    Rapid,
    Straight,
    Circular(Turn),
    /// A drilling cycle, by its number, of which this stage makes the move to the hole.
    Cycle(u32),
}

/// The plane of arcs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Plane {
    Xy,
    /// Seen from +Y: the first axis is Z.
    Zx,
    Yz,
}

/// What a code asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Code {
    Motion(Mode),
    Plane(Plane),
    /// The unit of lengths, in mm.
    Unit(f64),
    Relative(bool),
    AbsoluteCentres(bool),
    FeedPerMinute,
    CyclesEnd,
    /// G28, to the reference point.
    Reference,
    /// G30, to another.
    SecondReference,
    /// G4.
    Dwell,
    MachineCoordinates,
    WorkOffset,
    /// G92 and G52.
    Position,
    End,
    PassedOver(PassedOver),
    Refused(&'static str),
}

/// A code that moves neither X nor Y.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PassedOver {
    /// What is noted of it: its kind.
    pub(crate) note: &'static str,
    /// The letters beside it that are its own.
    pub(crate) own: &'static str,
    /// With one of these letters it would move X or Y: the letters, and how.
    pub(crate) unless: (&'static str, &'static str),
}

const ALL_LETTERS: &str = "ABCDEFHIJKLOPQRSTUVWXYZ";

pub(crate) const AXES: &str = "passed over, the stage has no such axis";
pub(crate) const EXTRUDER: &str = "passed over, there is no extruder";
pub(crate) const SPINDLE: &str = "passed over, there is no spindle and no laser";
pub(crate) const TOOLS: &str = "passed over, there are no tools to change or to measure";
pub(crate) const PROGRAM_NUMBER: &str = "a program's number, passed over";
pub(crate) const HIGH_FEED: &str = "above what the motors can follow, run at 6000 mm/min";
pub(crate) const DELETABLE: &str = "run: no switch deletes blocks here";
pub(crate) const AFTER_END: &str = "after the program's end, not run";
pub(crate) const HOMED: &str = "the reference point is the drawing's zero";
pub(crate) const MACHINE: &str = "the machine's coordinates are the drawing's";
pub(crate) const WORK_OFFSET: &str = "passed over, the work offset is always 0";
pub(crate) const CYCLE: &str = "a rapid move to the hole, which is not drilled";
pub(crate) const POSITION: &str = "passed over, X and Y stay as they are";
pub(crate) const VERTICAL_ARC: &str = "an arc that is a line seen from above";
const COOLANT: &str = "passed over, there is no coolant and no air";
const PAUSES: &str = "passed over, nobody is waited for";
pub(crate) const DWELLS: &str = "passed over, the stage does not dwell";
const EXACT: &str = "passed over, the path is always followed exactly";
const OFF: &str = "passed over, what it ends is never begun here";
const FUNCTIONS: &str = "passed over, they move neither X nor Y";

const fn passed(note: &'static str, own: &'static str) -> Code {
    passed_unless(note, own, "", "")
}

const fn passed_unless(
    note: &'static str,
    own: &'static str,
    letters: &'static str,
    how: &'static str,
) -> Code {
    Code::PassedOver(PassedOver {
        note,
        own,
        unless: (letters, how),
    })
}

const RADIUS: &str = "the tool's radius would move the path aside";
const ZERO: &str = "it would move the zero of X and Y";
const UNKNOWN: &str = "no code of this stage";
const FEED: &str = "F would not be in mm/min";
pub(crate) const SUBPROGRAM: &str = "a subprogram would move X and Y";

/// The meaning of a letter G or M with a number in tenths, as G90.1 is 901.
pub(crate) const fn meaning(letter: char, tenths: u32) -> Code {
    let number = (tenths / 10, tenths % 10);
    match letter {
        'G' => general(number),
        _ => miscellaneous(number),
    }
}

const fn general(number: (u32, u32)) -> Code {
    match number {
        (0, 0) => Code::Motion(Mode::Rapid),
        (1, 0) => Code::Motion(Mode::Straight),
        (2, 0) => Code::Motion(Mode::Circular(Turn::Clockwise)),
        (3, 0) => Code::Motion(Mode::Circular(Turn::CounterClockwise)),
        (cycle @ (73 | 74 | 81..=86 | 89), 0) => Code::Motion(Mode::Cycle(cycle)),
        (80, 0) => Code::CyclesEnd,
        (17, 0) => Code::Plane(Plane::Xy),
        (18, 0) => Code::Plane(Plane::Zx),
        (19, 0) => Code::Plane(Plane::Yz),
        (20, 0) => Code::Unit(25.4),
        (21, 0) => Code::Unit(1.0),
        (90, 0) => Code::Relative(false),
        (91, 0) => Code::Relative(true),
        (90, 1) => Code::AbsoluteCentres(true),
        (91, 1) => Code::AbsoluteCentres(false),
        (94, 0) => Code::FeedPerMinute,
        (28, 0) => Code::Reference,
        (30, 0) => Code::SecondReference,
        (53, 0) => Code::MachineCoordinates,
        (54, 0 | 1) | (55..=58, 0) | (59, 0..=3) => Code::WorkOffset,
        (52 | 92, 0) => Code::Position,
        (93 | 95, 0) => Code::Refused(FEED),
        (41 | 42, 0 | 1) => Code::Refused(RADIUS),
        (51, 0 | 1) | (68, 0 | 2) | (16, 0) => {
            Code::Refused("scaling, mirroring, rotation and polar coordinates are not done")
        }
        (65 | 66, 0) => Code::Refused(SUBPROGRAM),
        (70 | 71, 0) => Code::Refused("it is no unit everywhere: use G20 or G21"),
        (76 | 87 | 88, 0) => Code::Refused("a cycle that moves the tool aside"),
        (4, 0) => Code::Dwell,
        (9, 0) | (61, 0 | 1) => passed(EXACT, ""),
        (64, 0) => passed(EXACT, "PQ"),
        (5, 0 | 1) => passed_unless(EXACT, "PQIJR", "XY", "splines are not done"),
        (10 | 11, 0) => passed_unless(EXTRUDER, "PRSZ", "XYL", ZERO),
        (29, 0) => passed_unless(FUNCTIONS, ALL_LETTERS, "XY", "it would move X and Y"),
        (31, 0) | (38, 2..=5) => passed_unless(
            FUNCTIONS,
            "ABCZ",
            "XY",
            "where probing ends is not known before",
        ),
        (40 | 44 | 49, 0) | (43, 0 | 2) => passed(TOOLS, "H"),
        (43, 1) => passed_unless(TOOLS, "HZABC", "XY", "the tool's length would move X and Y"),
        (50, 0) => passed_unless(OFF, "S", "XY", ZERO),
        (15 | 69, 0) | (50, 1) | (92, 1..=3) => passed(OFF, ""),
        (96 | 97, 0) => passed(SPINDLE, "SD"),
        (98 | 99, 0) => passed(FUNCTIONS, ""),
        _ => Code::Refused(UNKNOWN),
    }
}

const fn miscellaneous(number: (u32, u32)) -> Code {
    match number {
        (2 | 30, 0) => Code::End,
        (0 | 1 | 60, 0) => passed(PAUSES, "PS"),
        (3..=5 | 19, 0) => passed(SPINDLE, "SPIOQ"),
        (6, 0) => passed(TOOLS, ""),
        (7..=9, 0) => passed(COOLANT, "PS"),
        (82 | 83, 0) => passed(EXTRUDER, ""),
        (32 | 97 | 98 | 99, 0) => Code::Refused(SUBPROGRAM),
        (47 | 808, 0) => Code::Refused("the program would be repeated"),
        (72, 0) => Code::Refused("the modes to go back to are not known"),
        (206 | 218 | 428 | 852, 0) => Code::Refused(ZERO),
        (290, 0) => passed_unless(FUNCTIONS, ALL_LETTERS, "XY", ZERO),
        // Limits, currents and switches of each axis.
        (
            17
            | 18
            | 84
            | 92
            | 201
            | 203
            | 205
            | 350
            | 351
            | 566
            | 569
            | 574
            | 584
            | 665
            | 666
            | 851
            | 906..=919,
            0,
        ) => passed(FUNCTIONS, ALL_LETTERS),
        (_, 0) => passed_unless(
            FUNCTIONS,
            ALL_LETTERS,
            "XY",
            "whether X and Y are its own or a motion's is not known",
        ),
        _ => Code::Refused(UNKNOWN),
    }
}
