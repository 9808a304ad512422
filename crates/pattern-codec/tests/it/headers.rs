//! C headers of engraving records and timer reloads, and the items of any header.

use pattern_codec::c_header::{Dialect, HeaderErrorKind as K, Item, items};
use pattern_codec::engraving::{
    Axis, Format, PatternData, PatternHeader, ReloadData, ReloadHeader, Strictness, TimerPeriod,
};
use proptest::prelude::*;

use crate::common::{fast, formats, records, slow};

fn period(reload: u16) -> TimerPeriod {
    TimerPeriod {
        reload,
        toggles: true,
    }
}

fn dialect(sdcc: bool) -> Dialect {
    if sdcc { Dialect::Sdcc } else { Dialect::C51 }
}

proptest! {
    #[test]
    fn records_are_read_as_written(records in prop::collection::vec(records(), 1..60), format in formats(), other in formats(), sdcc: bool) {
        let header = PatternHeader { name: "rosette", dialect: dialect(sdcc), format };
        let mut text = String::new();
        header.write(records.iter().copied(), &mut text).unwrap();
        // What the header says counts, not what the reader expects.
        let data = PatternData::read(&text, other).unwrap();
        prop_assert_eq!(data.name(), "rosette");
        prop_assert_eq!(data.format(), format.with_strictness(other.strictness));
        prop_assert_eq!(data.record_count(), records.len() as u64);
        prop_assert!(data.records().eq(records.iter().copied()));
    }

    #[test]
    fn reloads_are_read_as_written(periods in prop::collection::vec((any::<u16>(), any::<bool>()), 1..60), sdcc: bool) {
        let periods = periods.into_iter().map(|(reload, toggles)| TimerPeriod { reload, toggles });
        let header = ReloadHeader { name: "elbow", dialect: dialect(sdcc) };
        let mut text = String::new();
        header.write(periods.clone(), &mut text).unwrap();
        let data = ReloadData::read(&text, "elbow").unwrap();
        prop_assert_eq!(data.period_count(), periods.len() as u64);
        prop_assert!(data.periods().eq(periods));
    }

    #[test]
    fn any_text_is_a_header_or_an_error(text in "[ \n\\\\/*#p_{}\\[\\](),;=0-9x-]{0,60}") {
        for text in [format!("#define p 31\nint p[]={{0x1F,{text}"), text] {
            let _ = PatternData::read(&text, Format::new());
            let _ = ReloadData::read(&text, "p");
        }
    }
}

#[test]
fn a_pattern_looks_like_this() {
    let records = [fast(Axis::Vertical, -400), slow(15, -30, 2)];
    let mut text = String::new();
    let header = PatternHeader {
        dialect: Dialect::Sdcc,
        ..PatternHeader::new(Format::new())
    };
    header.write(records, &mut text).unwrap();
    let wanted = "\
/* pattern: 2 records, 1 FAST and 1 SLOW, 6 bytes.
   Pulses: elbow 15, shoulder 30, disc 2, vertical 400. */
#ifndef PATTERN_H
#define PATTERN_H

#define PATTERN_RECORDS 2
#define PATTERN_BYTES 6
#define PATTERN_ELBOW_CODE 0
#define PATTERN_SHOULDER_CODE 1
#define PATTERN_DISC_CODE 2
#define PATTERN_VERTICAL_CODE 3
#define PATTERN_HIGH_BYTE_FIRST 1

const __code unsigned char pattern[6] = {
  0xFF, 0x01, 0x90,
  0x02, 0x0F, 0x9E
};

#endif
";
    assert_eq!(text, wanted);
}

#[test]
fn reloads_look_like_this() {
    let periods = (0..9).map(|k| TimerPeriod {
        reload: 0xF000 + k,
        toggles: k != 2,
    });
    let mut text = String::new();
    ReloadHeader::DEFAULT.write(periods, &mut text).unwrap();
    let wanted = "\
/* reloads: 9 timer periods, 8 edges, 20 bytes. */
#ifndef RELOADS_H
#define RELOADS_H

#define RELOADS_COUNT 9

unsigned int code reloads[9] = {
  0xF000, 0xF001, 0xF002, 0xF003, 0xF004, 0xF005, 0xF006, 0xF007,
  0xF008
};

/* Bit k of byte j: whether the pin toggles after period 8 j + k. */
unsigned char code reloads_toggles[2] = {
  0xFB, 0x01
};

#endif
";
    assert_eq!(text, wanted);
}

#[test]
fn a_pattern_by_hand_is_read() {
    let text = "
        #define PATH_VERTICAL_CODE 0   /* swapped */
        #define PATH_ELBOW_CODE   3
        #define PATH_HIGH_BYTE_FIRST 0
        code unsigned char path[][3] = {
            { 0x9F, 0x90, 0x01 },      // lift by -400
            { 0x02, 017, -98 },
        };";
    let data = PatternData::read(text, Format::new()).unwrap();
    let records = [fast(Axis::Vertical, -400), slow(15, -30, 2)];
    assert!(data.records().eq(records));
}

#[test]
fn wrong_patterns_are_refused_with_line_and_column() {
    for (text, wanted) in [
        (
            "char p[] = {2, 0x1F, 1};",
            "line 1, column 22: pattern byte 1: 0x1F has 31 pulses for elbow in a SLOW record",
        ),
        (
            "char p[] = {2, 1, 1,\n0x20, 0, 0};",
            "line 2, column 10: pattern byte 3: 0x20 has D6 or D5 set",
        ),
        (
            "char p[] = {2, 1};",
            "line 1, column 17: pattern byte 0: the record that starts with 0x02 is cut off after 2 of 3",
        ),
        (
            "#define P_ELBOW_CODE 4\nchar p[] = {2, 1, 1};",
            "line 1, column 1: 4 does not fit into 0..=3",
        ),
        (
            "#define P_ELBOW_CODE 3\nchar p[] = {2, 1, 1};",
            "line 2, column 12: elbow and vertical: both have the axis code 3",
        ),
        (
            "#define P_RECORDS 2\nchar p[] = {2, 1, 1};",
            "line 1, column 1: RECORDS is 2, 1 wanted",
        ),
        (
            "char p[] = {2, 1, 256};",
            "line 1, column 19: 256 does not fit into -128..=255",
        ),
    ] {
        let error = PatternData::read(text, Format::new())
            .map(|_| ())
            .unwrap_err();
        assert!(error.to_string().starts_with(wanted), "{error}: {text}");
    }
    let lenient = Format::new().with_strictness(Strictness::Lenient);
    assert!(PatternData::read("char p[] = {0x20, 0, 0};", lenient).is_ok());
    assert!(PatternData::read("char p[] = {2, 0x1F, 1};", lenient).is_err());
}

#[test]
fn reloads_stand_eight_in_a_row() {
    let mut text = String::new();
    let header = ReloadHeader::DEFAULT;
    header.write((0..17).map(period), &mut text).unwrap();
    let rows: Vec<_> = text
        .lines()
        .filter(|line| line.starts_with("  0x00"))
        .collect();
    assert_eq!(
        rows,
        [
            "  0x0000, 0x0001, 0x0002, 0x0003, 0x0004, 0x0005, 0x0006, 0x0007,",
            "  0x0008, 0x0009, 0x000A, 0x000B, 0x000C, 0x000D, 0x000E, 0x000F,",
            "  0x0010"
        ]
    );
}

#[test]
fn reloads_by_hand_are_read() {
    let text = "unsigned int code shoulder[] = { -4096, 0xF00B, 0 };\nchar other[] = { 1 };";
    let data = ReloadData::read(text, "shoulder").unwrap();
    let periods = [0xF000, 0xF00B, 0].map(period);
    assert!(data.periods().eq(periods));
    let array = |values, declared| K::ArrayLength { values, declared };
    let range = |value, min, max| K::Range { value, min, max };
    let (name, value, wanted) = ("COUNT", 2, 1);
    for (text, at, kind) in [
        (
            "int r[] = { 65536 };",
            [1, 13],
            range(65_536, -32_768, 65_535),
        ),
        (
            "int r[] = { 1 }; char r_toggles[] = { 1, 2 };",
            [1, 44],
            array(2, 1),
        ),
        (
            "int r[] = { 1 }; char r_toggles[] = { 256 };",
            [1, 39],
            range(256, -128, 255),
        ),
        ("int s[] = { 1 };", [1, 17], K::NoArray),
        (
            "#define R_COUNT 2\nint r[] = { 1 };",
            [1, 1],
            K::Define {
                name,
                value,
                wanted,
            },
        ),
    ] {
        let error = ReloadData::read(text, "r").map(|_| ()).unwrap_err();
        let place = [error.location.line, error.location.column];
        assert_eq!((place, error.kind), (at, kind), "{text}");
    }
}

#[test]
fn a_comment_goes_on_behind_a_backslash() {
    for line_end in ["\n", "\r\n", "\r"] {
        let text = "char a[] = { 1, // C:\\@2,\\@3,@4 };".replace('@', line_end);
        let found: Result<Vec<_>, _> = items(&text).collect();
        let found = found.unwrap();
        let values: Vec<_> = found
            .iter()
            .map(|(place, item)| (place.line, *item))
            .collect();
        let wanted = [
            (1, Item::Array { name: "a" }),
            (1, Item::Value(1)),
            (4, Item::Value(4)),
            (4, Item::End),
        ];
        assert_eq!(values, wanted, "{line_end:?}");
    }
}

#[test]
fn items_have_their_places() {
    let text = "#ifndef H\n#define H\n# define WORD 0x7FFFFFFFUL // long\n#define HALF(x) 2\n\nlong a [ 2 ] = { WORD, -HALF };\n#endif";
    let (found, wanted) = ('H', "a number");
    let error = items(text).find_map(Result::err).unwrap();
    assert_eq!((error.location.line, error.location.column), (6, 25));
    assert_eq!(error.kind, K::Unexpected { found, wanted });
    let text = text.replace("-HALF", "-(WORD)");
    let found: Result<Vec<_>, _> = items(&text).collect();
    let found: Vec<_> = found
        .unwrap()
        .into_iter()
        .map(|(place, item)| (place.line, place.column, item))
        .collect();
    let (name, value) = ("WORD", 0x7FFF_FFFF);
    let wanted = [
        (3, 1, Item::Define { name, value }),
        (6, 16, Item::Array { name: "a" }),
        (6, 18, Item::Value(value)),
        (6, 24, Item::Value(-value)),
        (6, 32, Item::End),
    ];
    assert_eq!(found, wanted);
}
