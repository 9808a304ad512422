//! Dance frames: packings, headers, and what is refused.

use pattern_codec::c_header::Dialect;
use pattern_codec::dance::{
    Data, DataHeader, DecodeError, Packing, ProgramMemory, Sizes, Threshold, Timing,
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
    fn error(packing: Packing, bytes: &[u8]) -> Option<DecodeError> {
        let mut frames = packing.decode::<3, _>(bytes.iter().copied());
        frames.find_map(Result::err)
    }
    for (packing, bytes, wanted) in [
        (
            Packing::Raw,
            &[1, 2, 3, 4, 5][..],
            "dance byte 3: the last frame or run is cut off",
        ),
        (
            Packing::Runs,
            &[2, 1, 2, 3, 0, 4, 5, 6],
            "dance byte 4: a run of 0 frames",
        ),
        (
            Packing::Runs,
            &[2, 1, 2],
            "dance byte 0: the last frame or run is cut off",
        ),
        (
            Packing::MaskedRuns,
            &[1, 0, 1, 8],
            "dance byte 2: mask 0x08 names more than the 3 motors of its byte",
        ),
        (
            Packing::MaskedRuns,
            &[1, 7, 1, 8],
            "dance byte 0: the last frame or run is cut off",
        ),
        (
            Packing::MaskedRuns,
            &[1],
            "dance byte 0: the last frame or run is cut off",
        ),
    ] {
        assert_eq!(error(packing, bytes).unwrap().to_string(), wanted);
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
    for (text, wanted) in [
        ("", "line 1, column 1: the text ends without the array"),
        (
            "/* é */ char d[] = {é};",
            "line 1, column 21: 'é' where a number must stand",
        ),
        (
            "char d[] = {\n 1, 300};",
            "line 2, column 5: 300 does not fit into -128..=255",
        ),
        (
            "char d[] =\r\n{1,\r\n 300};",
            "line 3, column 2: 300 does not fit into -128..=255",
        ),
        (
            "char d[] = {1,\n\t-129};",
            "line 2, column 2: -129 does not fit into -128..=255",
        ),
        (
            "char d[] = {1, 99999999999};",
            "line 1, column 16: this number has more than 32 bits",
        ),
        (
            "char d[] = {1, 0x};",
            "line 1, column 16: this is not a number",
        ),
        (
            "char d[] = {1, 08};",
            "line 1, column 16: this is not a number",
        ),
        (
            "char d[] = {1, STOP};\n#define STOP 0",
            "line 1, column 16: 'S' where a number must stand",
        ),
        (
            "char d[] = {1,, 2};",
            "line 1, column 15: ',' where a number must stand",
        ),
        (
            "char d[] = {1 2};",
            "line 1, column 15: '2' where , or } must stand",
        ),
        (
            "char d[] = {1, (2};",
            "line 1, column 18: '}' where ) must stand",
        ),
        (
            "char d[] = {1, 2",
            "line 1, column 17: the text ends where , or } must stand",
        ),
        (
            "char d[] = {1, /* 2",
            "line 1, column 16: this comment has no end",
        ),
        (
            "char d[3] = {1, 2};",
            "line 1, column 18: an array of 2 values, declared are 3",
        ),
        (
            "char d[][2] = {{1, 2}, {3}};",
            "line 1, column 26: a row of 1 values, declared are 2",
        ),
        (
            "char d[] = {{1, 2}, {3, 4}};",
            "line 1, column 13: a row in an array",
        ),
        (
            "char d[][2][2] = {1, 2};",
            "line 1, column 12: the array has more than two dimensions",
        ),
        (
            "char d[] = {1, 2, 3};",
            "line 1, column 20: the last frame or run is cut off",
        ),
        (
            "char a[] = {1, 2};\nchar b[] = {1, 2};",
            "line 2, column 12: a second array",
        ),
        (
            "#define D_MOTORS 8\nchar d[] = {1, 2};",
            "line 1, column 1: MOTORS is 8, 2 wanted",
        ),
        (
            "\n#define D_FRAMES 2\nchar d[] = {1, 2};",
            "line 2, column 1: FRAMES is 2, 1 wanted",
        ),
        (
            "char d[] = {1, 2};\n  #define D_BYTES 3",
            "line 2, column 3: BYTES is 3, 2 wanted",
        ),
        (
            "#define D_PACKING 3\nchar d[] = {1, 2};",
            "line 1, column 1: 3 does not fit into 0..=2",
        ),
        (
            "#define D_FRAME_TICKS 0\nchar d[] = {1, 2};",
            "line 1, column 1: 0 does not fit into 1..=",
        ),
        (
            "#define D_THRESHOLD 127\nchar d[] = {1, 2};",
            "line 1, column 1: 127 does not fit into 128..=65535",
        ),
        (
            "#define D_PACKING 1\nchar d[] = {0,\n 1, 2};",
            "line 3, column 5: a run of 0 frames",
        ),
    ] {
        let error = Data::<2>::read(text).map(|_| ()).unwrap_err().to_string();
        assert!(error.starts_with(wanted), "{error}: {text}");
    }
}

#[test]
fn tables_that_no_firmware_holds_are_not_written() {
    let write = |count| DataHeader::DEFAULT.write(vec![[0; 8]; count], &mut String::new());
    assert_eq!(write(0).unwrap_err().to_string(), "a table without values");
    let error = write(8193).unwrap_err().to_string();
    assert_eq!(error, "a table of 65544 bytes, an 8051 addresses 65536");
    assert!(write(8192).is_ok());
    let error = Threshold::new(127).unwrap_err();
    assert_eq!(error.to_string(), "a threshold of 127, min 128");
    for (name, wanted) in [
        ("", "the name of a table is empty"),
        ("xdata", "a table cannot have a keyword"),
        ("1st", "'1' cannot stand in the name"),
        ("a b", "' ' cannot stand in the name"),
        (
            "abcdefghijklmnopqrstuvwxyz_abcdef",
            "a table's name of 33 characters, max 31",
        ),
    ] {
        let header = DataHeader {
            name,
            ..DataHeader::DEFAULT
        };
        let error = header.write([[0; 8]], &mut String::new()).unwrap_err();
        let error = error.to_string();
        assert!(error.starts_with(wanted), "{error}");
    }
}
