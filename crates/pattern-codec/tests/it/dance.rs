//! Dance frames: packings, headers, and what is refused.

use pattern_codec::c_header::{Dialect, HeaderErrorKind as K, WriteError};
use pattern_codec::dance::{
    Data, DataHeader, DecodeErrorKind as F, Packing, ProgramMemory, Sizes, Threshold, Timing,
};
use proptest::prelude::*;

/// Frames with runs in them, some longer than one count holds.
fn frames<const N: usize>() -> impl Strategy<Value = Vec<[i8; N]>> {
    let speed = prop_oneof![Just(0), Just(60), Just(-128), Just(127), any::<i8>()];
    let frame = prop::array::uniform(speed);
    let run = (frame, prop_oneof![4 => 1_usize..4, 1 => 250_usize..520]);
    prop::collection::vec(run, 1..8).prop_map(|runs| {
        runs.into_iter()
            .flat_map(|(frame, n)| vec![frame; n])
            .collect()
    })
}

fn packings() -> impl Strategy<Value = Packing> {
    prop::sample::select(&Packing::ALL[..])
}

fn round_trip<const N: usize>(packing: Packing, frames: &[[i8; N]]) {
    let bytes: Vec<u8> = packing.encode(frames.iter().copied()).collect();
    let decoded: Result<Vec<_>, _> = packing.decode::<N, _>(bytes.iter().copied()).collect();
    assert_eq!(decoded.unwrap(), frames);
    let sizes = Sizes::of(frames.iter().copied());
    assert_eq!(sizes.bytes(packing), u64::try_from(bytes.len()).unwrap());
    assert!(sizes.bytes(sizes.smallest()) <= sizes.bytes(packing));
    assert_eq!(sizes.frames(), u64::try_from(frames.len()).unwrap());
}

/// A text with more blanks, comments and line ends of another kind between its words.
fn loosened(text: &str) -> String {
    let mut loose = String::new();
    for line in text.lines() {
        loose += "\t ";
        loose += line;
        loose += if line.starts_with('#') {
            "\r\n"
        } else {
            "/* x\ny */ \r"
        };
    }
    loose.replace(", ", ",").replace('{', "\n{ ")
}

proptest! {
    #[test]
    fn what_is_packed_is_unpacked(packing in packings(), eight in frames::<8>(), one in frames::<1>(), many in frames::<19>()) {
        round_trip(packing, &eight);
        round_trip(packing, &one);
        round_trip(packing, &many);
    }

    #[test]
    fn any_bytes_are_frames_or_an_error(packing in packings(), bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let mut decoded = packing.decode::<9, _>(bytes.iter().copied());
        let frames: Vec<_> = decoded.by_ref().map_while(Result::ok).collect();
        prop_assert!(decoded.next().is_none());
        let all: Result<Vec<_>, _> = packing.decode::<9, _>(bytes.iter().copied()).collect();
        if let Ok(all) = all {
            prop_assert_eq!(&all, &frames);
            let shortest: Vec<_> = packing.encode(frames.iter().copied()).collect();
            prop_assert!(shortest.len() <= bytes.len());
            prop_assert!(packing.decode(shortest).map(Result::unwrap).eq(frames.iter().copied()));
        }
    }

    #[test]
    fn what_is_written_is_read(packing in packings(), frames in frames::<8>(), sdcc: bool, tick_us in 1..=u32::MAX, frame_ticks in 1..=u32::MAX, threshold in 128..=u16::MAX) {
        let timing = Timing::new(tick_us, frame_ticks).unwrap();
        let header = DataHeader {
            name: "Waltz_3",
            dialect: if sdcc { Dialect::Sdcc } else { Dialect::C51 },
            timing,
            threshold: Threshold::new(threshold).unwrap(),
            packing,
        };
        let mut text = String::new();
        header.write(frames.iter().copied(), &mut text).unwrap();
        for text in [loosened(&text), text] {
            let data = Data::<8>::read(&text).unwrap();
            prop_assert_eq!((data.name(), data.timing(), data.packing()), ("Waltz_3", timing, packing));
            prop_assert_eq!(data.threshold().get(), threshold);
            prop_assert_eq!(data.frame_count(), frames.len() as u64);
            prop_assert!(data.frames().eq(frames.iter().copied()));
        }
    }

    #[test]
    fn any_text_is_a_header_or_an_error(text in "[ \n\r\\\\/*#a-c{}\\[\\](),;=0-9x\"'-]{0,80}") {
        for text in [format!("char a[]={{1,{text}"), text] {
            if let Err(error) = Data::<2>::read(&text) {
                let lines = u32::try_from(text.split(['\n', '\r']).count()).unwrap();
                prop_assert!(error.location.line <= lines && error.location.column > 0, "{error}");
            }
        }
    }
}

#[test]
fn a_run_is_at_most_255_frames() {
    let bytes = |frames| -> Vec<u8> {
        let frames = core::iter::repeat_n([5, -5], frames);
        Packing::Runs.encode(frames).collect()
    };
    assert_eq!(bytes(255), [255, 5, 0xFB]);
    assert_eq!(bytes(256), [255, 5, 0xFB, 1, 5, 0xFB]);
    let frames = core::iter::repeat_n([5, -5], 511);
    let masked: Vec<u8> = Packing::MaskedRuns.encode(frames).collect();
    assert_eq!(masked, [255, 0b11, 5, 0xFB, 255, 0, 1, 0]);
}

#[test]
fn the_turn_on_the_spot() {
    // [Dancer]: wheels at +60 and -60 for 25 frames, 5000 ms.
    let frames = [[0, 0, 0, 0, 0, 0, 60, -60]; 25];
    let mut text = String::new();
    let header = DataHeader {
        packing: Packing::MaskedRuns,
        ..DataHeader::DEFAULT
    };
    header.write(frames, &mut text).unwrap();
    let wanted = "\
/* dance: 25 frames of 8 motors, 5000 ms.
   Bytes: 200 raw, 9 as runs, 4 as masked runs; here masked runs. */
#ifndef DANCE_H
#define DANCE_H

#define DANCE_MOTORS 8
#define DANCE_FRAMES 25
#define DANCE_FRAME_TICKS 200
#define DANCE_TICK_US 1000
#define DANCE_THRESHOLD 600
#define DANCE_PACKING 2
#define DANCE_BYTES 4

/* Each row: count of frames, mask, speeds of the motors in the mask. */
unsigned char code dance[4] = {
  25, 0xC0, 0x3C, 0xC4
};

#endif
";
    assert_eq!(text, wanted);
}

#[test]
fn five_minutes_do_not_fit_raw() {
    let frames = (0..1500_i32).map(|k| [i8::try_from(k % 100).unwrap(); 8]);
    let sizes = Sizes::of(frames);
    assert_eq!(sizes.bytes(Packing::Raw), 12_000);
    assert_eq!(sizes.smallest(), Packing::Raw);
    assert!(!ProgramMemory::AT89C52.fit(12_000, 0).fits());
    let fit = ProgramMemory::AT89C51.fit(4000, 96);
    assert!(fit.fits());
    let text = "4000 bytes of data and 96 of code fit into 4096 bytes: 0 left";
    assert_eq!(fit.to_string(), text);
}

#[test]
fn bytes_that_are_no_frames_are_refused_with_their_place() {
    let (mask, motors) = (8, 3);
    for (packing, bytes, offset, kind) in [
        (Packing::Raw, &[1, 2, 3, 4, 5][..], 3, F::Truncated),
        (Packing::Runs, &[2, 1, 2, 3, 0, 4, 5, 6], 4, F::ZeroCount),
        (Packing::Runs, &[2, 1, 2], 0, F::Truncated),
        (
            Packing::MaskedRuns,
            &[1, 0, 1, 8],
            2,
            F::Mask { mask, motors },
        ),
        (Packing::MaskedRuns, &[1, 7, 1, 8], 0, F::Truncated),
        (Packing::MaskedRuns, &[1], 0, F::Truncated),
    ] {
        let mut frames = packing.decode::<3, _>(bytes.iter().copied());
        let error = frames.find_map(Result::err).unwrap();
        assert_eq!((error.offset, error.kind), (offset, kind), "{bytes:?}");
    }
}

#[test]
fn headers_by_hand_are_read() {
    let frames = [[60, -60], [0, 0]];
    for text in [
        "signed char code d[] = { 60, -60, 0, 0 };",
        "code char d[4]={0x3c,0XC4,00,0x0u,};",
        "static const __code int8_t\nd\n[\n2\n]\n[2]\n=\n{{+60,-(60)},{(0),0b0}};",
        "#define N 2\n#define FULL ( - 0x3C ) // speed\nchar d[][N] = {{60,FULL},{0,0}};",
        "#ifdef X\n#include \"char d[] = {1};\"\n#endif\n#error char d[] = {9};\nchar d[] = {074,/*1,*/-60,//2,\n0,\\\n0}",
        "int f(int (*g)(char d[4]), char d[]) { if (d[0]) { d[0] = 1; } char d[] = {9}; }\nextern char e[9];\nint n = 4, d[] = {60,-60,0,0};",
        "\u{FEFF}struct s { char e[3]; } x; char d[4] = {60, 196, 0, 0}, *p = 0;",
        "#define D_PACKING 1\r\n#define D_FRAMES 2\r\nchar d[] = {1, 60, 196,\r\n1, 0, 0};\r\n",
    ] {
        let data = Data::<2>::read(text).unwrap_or_else(|error| panic!("{error}: {text}"));
        assert!(data.frames().eq(frames), "{text}");
    }
    let two = "char a[2] = {1, 2}; char b[2] = {3, 4};";
    assert!(
        Data::<2>::read_array(two, "b")
            .unwrap()
            .frames()
            .eq([[3, 4]])
    );
}

#[test]
fn wrong_headers_are_refused_with_line_and_column() {
    let not = |found, wanted| K::Unexpected { found, wanted };
    let range = |value, min, max| K::Range { value, min, max };
    let byte = |value| range(value, -128, 255);
    let array = |values, declared| K::ArrayLength { values, declared };
    let row = |values, declared| K::RowLength { values, declared };
    let define = |name, value, wanted| K::Define {
        name,
        value,
        wanted,
    };
    let ended = K::UnexpectedEnd { wanted: ", or }" };
    let most = u32::MAX.into();
    for (text, at, kind) in [
        ("", [1, 1], K::NoArray),
        ("/* é */ char d[] = {é};", [1, 21], not('é', "a number")),
        ("char d[] = {\n 1, 300};", [2, 5], byte(300)),
        ("char d[] =\r\n{1,\r\n 300};", [3, 2], byte(300)),
        ("char d[] = {1,\n\t-129};", [2, 2], byte(-129)),
        ("char d[] = {1, 99999999999};", [1, 16], K::TooLarge),
        ("char d[] = {1, 0x};", [1, 16], K::NotANumber),
        ("char d[] = {1, 08};", [1, 16], K::NotANumber),
        (
            "char d[] = {1, STOP};\n#define STOP 0",
            [1, 16],
            not('S', "a number"),
        ),
        ("char d[] = {1,, 2};", [1, 15], not(',', "a number")),
        ("char d[] = {1 2};", [1, 15], not('2', ", or }")),
        ("char d[] = {1, (2};", [1, 18], not('}', ")")),
        ("char d[] = {1, 2", [1, 17], ended),
        ("char d[] = {1, /* 2", [1, 16], K::OpenComment),
        ("char d[3] = {1, 2};", [1, 18], array(2, 3)),
        ("char d[][2] = {{1, 2}, {3}};", [1, 26], row(1, 2)),
        ("char d[] = {{1, 2}, {3, 4}};", [1, 13], K::Row),
        ("char d[][2][2] = {1, 2};", [1, 12], K::Dimensions),
        ("char d[] = {1, 2, 3};", [1, 20], K::Frames(F::Truncated)),
        (
            "char a[] = {1, 2};\nchar b[] = {1, 2};",
            [2, 12],
            K::SecondArray,
        ),
        (
            "#define D_MOTORS 8\nchar d[] = {1, 2};",
            [1, 1],
            define("MOTORS", 8, 2),
        ),
        (
            "\n#define D_FRAMES 2\nchar d[] = {1, 2};",
            [2, 1],
            define("FRAMES", 2, 1),
        ),
        (
            "char d[] = {1, 2};\n  #define D_BYTES 3",
            [2, 3],
            define("BYTES", 3, 2),
        ),
        (
            "#define D_PACKING 3\nchar d[] = {1, 2};",
            [1, 1],
            range(3, 0, 2),
        ),
        (
            "#define D_FRAME_TICKS 0\nchar d[] = {1, 2};",
            [1, 1],
            range(0, 1, most),
        ),
        (
            "#define D_THRESHOLD 127\nchar d[] = {1, 2};",
            [1, 1],
            range(127, 128, 65_535),
        ),
        (
            "#define D_PACKING 1\nchar d[] = {0,\n 1, 2};",
            [3, 5],
            K::Frames(F::ZeroCount),
        ),
    ] {
        let error = Data::<2>::read(text).map(|_| ()).unwrap_err();
        let place = [error.location.line, error.location.column];
        assert_eq!((place, error.kind), (at, kind), "{text}");
    }
}

#[test]
fn tables_that_no_firmware_holds_are_not_written() {
    let write = |count| DataHeader::DEFAULT.write(vec![[0; 8]; count], &mut String::new());
    assert_eq!(write(0), Err(WriteError::Empty));
    let (bytes, limit) = (65_544, 65_536);
    assert_eq!(write(8193), Err(WriteError::TooLong { bytes, limit }));
    assert!(write(8192).is_ok());
    assert_eq!(Threshold::new(127).unwrap_err().threshold, 127);
    let character = |character| WriteError::NameCharacter { character };
    let length = 33;
    for (name, wanted) in [
        ("", WriteError::NameEmpty),
        ("xdata", WriteError::NameKeyword),
        ("1st", character('1')),
        ("a b", character(' ')),
        (
            "abcdefghijklmnopqrstuvwxyz_abcdef",
            WriteError::NameTooLong { length },
        ),
    ] {
        let header = DataHeader {
            name,
            ..DataHeader::DEFAULT
        };
        let refused = header.write([[0; 8]], &mut String::new());
        assert_eq!(refused, Err(wanted));
    }
}
