//! What a drawing shows and the engraver does not: one note for each kind, with its first place.

use super::{Run, nearest, run_body};
use crate::tools::artefacts::assert_refused;
use crate::tools::report::without_file;

/// What is said, without the name of the file.
fn notes(body: &str) -> Vec<String> {
    let run = run_body(body);
    let notes = without_file(&run.notes);
    assert_eq!(run.report["notes"], serde_json::json!(notes));
    notes
}

/// Something to draw besides what a case is about.
const LINE: &str = "<path d='M5 50H95L90 60' fill='none' stroke='black'/>\n";

#[test]
fn each_kind_is_said_with_its_first_place() {
    for (body, wanted) in [
        (
            "<text x='9' y='9'>a <tspan>b</tspan></text><text>c</text>",
            "<text>: convert text to paths (2 times)",
        ),
        (
            "<image width='5' height='5' href='data:image/png;base64,AA'/>",
            "<image>: pictures cannot be engraved (1 time)",
        ),
        (
            "<path d='M5 5H9' stroke='red' stroke-dasharray='2 1'/>",
            "<path>: dashed, cut solid (1 time)",
        ),
        (
            "<path d='M5 5H9' style='stroke:red;stroke-dasharray:2'/>",
            "<path>: dashed, cut solid (1 time)",
        ),
        (
            "<path d='M5 5H9' stroke='red' stroke-width='4'/>",
            "<path>: with a stroke-width, engraved as wide as the disc cuts (1 time)",
        ),
        (
            "<circle r='9' cx='20' cy='20'/><rect width='9' height='9'/>",
            "<circle>, <rect>: filled, only the outline is engraved (2 times)",
        ),
        (
            "<path d='M5 5L9 9'/>",
            "<path>: filled without an area, which does not show, engraved all the same (1 time)",
        ),
        (
            "<linearGradient id='g'><stop/><stop offset='1' stop-color='red'/></linearGradient>\
             <circle r='9' cx='20' cy='20' fill='url(#g)'/>",
            "<circle>: a gradient or a pattern, only the outline is engraved (1 time)",
        ),
        (
            "<pattern id='p' width='2' height='2'><path d='M0 0H2'/></pattern>\
             <path d='M5 5L20 20' stroke='url(#p)' fill='none'/>",
            "<path>: a gradient or a pattern, only the outline is engraved (1 time)",
        ),
        (
            "<path d='M5 5H9' stroke='red' opacity='.5'/>",
            "<path>: transparent or blended, engraved like the rest (1 time)",
        ),
        (
            "<g stroke-opacity='0.5'><path d='M5 5H9' stroke='red'/></g>",
            "<path>: transparent or blended, engraved like the rest (1 time)",
        ),
        (
            "<g style='mix-blend-mode:multiply'><path d='M5 5H9' stroke='red'/></g>",
            "<g>: transparent or blended, engraved like the rest (1 time)",
        ),
        (
            "<clipPath id='c'><circle r='9' cx='20' cy='20'/></clipPath>\
             <g clip-path='url(#c)'><path d='M5 5H9' stroke='red'/><path d='M5 9H9' stroke='red'/></g>",
            "<g>: clipped, engraved whole (1 time)",
        ),
        (
            "<clipPath id='c'><rect width='8' height='8'/></clipPath>\
             <path clip-path='url(#c)' d='M5 5H9' stroke='red'/>",
            "<path>: clipped, engraved whole (1 time)",
        ),
        (
            "<svg x='60' y='60' width='9' height='9'><path d='M0 0L12 3' fill='none' stroke='red'/></svg>",
            "<svg>: clipped, engraved whole (1 time)",
        ),
        (
            "<mask id='m'><rect width='9' height='9' fill='white'/></mask>\
             <path mask='url(#m)' d='M5 5L9 9' fill='none' stroke='red'/>",
            "<path>: masked, engraved whole (1 time)",
        ),
        (
            "<filter id='f'><feGaussianBlur stdDeviation='2'/></filter>\
             <path filter='url(#f)' d='M5 5L9 9' fill='none' stroke='red'/>",
            "<path>: filtered, engraved without the filter (1 time)",
        ),
        (
            "<path d='M90 5H109' stroke='red'/>",
            "<path>: beyond the page, engraved all the same (1 time)",
        ),
        (
            "<path d='M5 5H9' visibility='hidden' stroke='red'/><path d='M5 5H9' fill='none'/>",
            "<path>: hidden, or neither filled nor stroked, not engraved (2 times)",
        ),
        (
            "<path d='M5 5H9' fill='none'/>",
            "<path>: hidden, or neither filled nor stroked, not engraved (1 time)",
        ),
        (
            "<g display='none'><path d='M5 5H9' stroke='red'/></g>",
            "<path>: not displayed, not engraved (1 time)",
        ),
        (
            "<g style='fill:red; display : none !important'><path d='M5 5H9' stroke='red'/></g>",
            "<path>: not displayed, not engraved (1 time)",
        ),
        (
            "<use href='#nowhere'/>",
            "<use>: without size, data or a valid reference, or hidden by a style sheet, not engraved (1 time)",
        ),
        (
            "<use href='other.svg#part'/>",
            "<use>: without size, data or a valid reference, or hidden by a style sheet, not engraved (1 time)",
        ),
        (
            "<rect width='9' stroke='red'/>",
            "<rect>: without size, data or a valid reference, or hidden by a style sheet, not engraved (1 time)",
        ),
        (
            "<path d='' stroke='red'/>",
            "<path>: without size, data or a valid reference, or hidden by a style sheet, not engraved (1 time)",
        ),
        (
            "<path d='M5 5H9' transform='scale(0)' stroke='red'/>",
            "<path>: without size, data or a valid reference, or hidden by a style sheet, not engraved (1 time)",
        ),
        (
            "<style>.no { display: none }</style><path class='no' d='M5 5H9' stroke='red'/>",
            "<path>: without size, data or a valid reference, or hidden by a style sheet, not engraved (1 time)",
        ),
        (
            "<path d='M5 5H9 L oops 9' stroke='red'/>",
            "d=\"M5 5H9 L oops 9\": has an error, what follows it is not engraved (1 time)",
        ),
        (
            "<polyline points='5,5 9,5 20' stroke='red'/>",
            "points=\"5,5 9,5 20\": has an error, what follows it is not engraved (1 time)",
        ),
        (
            "<path d='M5 5H9' transform='rotate(45deg)' stroke='red'/>",
            "transform=\"rotate(45deg)\": cannot be read, engraved as if it were not there (1 time)",
        ),
        (
            "<line x1='1,5' y1='5' x2='9' y2='5' stroke='red'/>",
            "x1=\"1,5\": cannot be read, engraved as if it were not there (1 time)",
        ),
        (
            "<line x1='5' y1='5' x2='9' y2='5vw' stroke='red'/>",
            "y2=\"5vw\": cannot be read, engraved as if it were not there (1 time)",
        ),
        (
            "<svg viewBox='0 0 wide 9'><line x2='9' stroke='red'/></svg>",
            "viewBox=\"0 0 wide 9\": cannot be read, engraved as if it were not there (1 time)",
        ),
        (
            "<path d='M5 5H9' style='transform:translate(5px,2px)' stroke='red'/>",
            "transform: translate(5px,2px): styles that are not read, engraved as if they were not there (1 time)",
        ),
        (
            "<style>@media print { path { stroke: none } }</style>",
            "@media: styles that are not read, engraved as if they were not there (1 time)",
        ),
        (
            "<style>line { cx : 9; x: 5 }</style>",
            "cx: 9, x: 5: styles that are not read, engraved as if they were not there (2 times)",
        ),
        (
            "<animate attributeName='x'/><script>1</script>",
            "<animate>, <script>: does not run, engraved as at the start (2 times)",
        ),
        (
            "<flowRoot><flowRegion><rect width='9' height='9'/></flowRegion></flowRoot>",
            "<flowRoot>: no shape, not engraved (1 time)",
        ),
        (
            "<foreignObject><p xmlns='http://www.w3.org/1999/xhtml'>x</p></foreignObject>",
            "<foreignObject>: no shape, not engraved (1 time)",
        ),
    ] {
        let notes = notes(&format!("\n{LINE}{body}"));
        let [note] = &notes[..] else {
            panic!("{body}: {notes:?}");
        };
        let (place, told) = note.split_once(": ").unwrap();
        assert!(place.starts_with("line 3, column "), "{body}: {note}");
        assert_eq!(told, wanted, "{body}");
    }
}

/// Counted over the file, in the order of their first places; a style sheet outside of the root
/// as well.
#[test]
fn many_are_one_note_for_each_kind() {
    let dashed = "<path d='M5 5H9' stroke='red' stroke-dasharray='2'/>";
    let filled = "<rect id='r' x='20' y='20' width='9' height='9'/>";
    let body =
        format!("{LINE}<g>\n  {dashed}{dashed}</g>\n{filled}\n<use href='#r' y='9'/>{dashed}");
    assert_eq!(
        notes(&body),
        [
            "line 3, column 3: <path>: dashed, cut solid (3 times)",
            "line 4, column 1: <rect>, <use>: filled, only the outline is engraved (2 times)",
        ]
    );
    let run = Run::of_text(
        "<?xml-stylesheet href='a.css'?>\n<svg xmlns='http://www.w3.org/2000/svg' width='90' \
         height='90'><path d='M5 5H9' stroke='red'/></svg>",
        &[],
    );
    let note = "line 1, column 1: xml-stylesheet: styles that are not read, engraved as if they \
                were not there (1 time)";
    assert_eq!(run.report["notes"], serde_json::json!([note]));
}

/// What looks like something that is lost, and is engraved as it is shown.
#[test]
fn nothing_is_said_of_what_is_engraved() {
    for body in [
        "<title>t</title><desc>d</desc><metadata><x xmlns='http://other/'>y</x></metadata>",
        "<defs><path id='p' d='M0 0H9' stroke='red'/></defs><use href='#p' x='5' y='5'/>",
        "<symbol id='s' viewBox='0 0 9 9'><path d='M0 0H9' stroke='red'/></symbol>\
         <use href='#s' width='9' height='9'/>",
        "<svg x='60' y='60' width='9' height='9'><path d='M1 1L9 3' fill='none' stroke='red'/></svg>",
        "<clipPath id='c'><rect width='100' height='100'/></clipPath>\
         <g clip-path='url(#c)'><path d='M5 5H9' stroke='red'/></g>",
        "<clipPath id='c'><use href='#page'/></clipPath><defs><rect id='page' width='100' \
         height='100'/></defs><g clip-path='url(#c)'><path d='M5 5H9' stroke='red'/></g>",
        "<switch><foreignObject requiredExtensions='http://other/'/><g>\
         <path d='M5 5H9' stroke='red'/></g></switch>",
        "<style>@font-face { font-family: x } path { stroke: red }</style><path d='M5 5H9'/>",
        "<a href='http://other/'><path d='M5 5H9' transform='none' stroke='red'/></a>",
        "<linearGradient id='unused'><stop/></linearGradient><clipPath id='unused-too'>\
         <path d='M5 5H9'/></clipPath>",
        "<path d='M5 5h4v-4z M1 1' fill='none' stroke='red'/>",
        "<path xmlns:other='http://other/' other:d='x' d='M5 5H9' stroke='red'/>",
        "<rect x='5' y='5' width='9mm' height='10%' rx='auto' fill='none' stroke='red'/>",
    ] {
        assert_eq!(notes(&format!("{LINE}{body}")), [""; 0], "{body}");
    }
}

/// Markers are shapes at the ends of lines, and parts of the drawing.
#[test]
fn markers_are_engraved() {
    let run = run_body(
        "<marker id='m' markerWidth='9' markerHeight='9' refX='0' refY='0' overflow='visible' \
         markerUnits='userSpaceOnUse'><path d='M0 0L9 9' fill='none' stroke='red'/></marker>\
         <path d='M20 20H60' fill='none' stroke='red' marker-end='url(#m)'/>",
    );
    assert!(nearest(&run, 69.0, 29.0) <= run.number("/bound_mm"));
    assert_eq!(run.notes, [""; 0]);
}

/// As drawing programs write them: with a document type, entities, without a namespace.
#[test]
fn files_with_a_document_type_are_read() {
    for (head, attributes, body) in [
        (
            "<!DOCTYPE svg PUBLIC '-//W3C//DTD SVG 1.1//EN' 'http://www.w3.org/svg11.dtd'>",
            "xmlns='http://www.w3.org/2000/svg'",
            "<path d='M5 5L9 9' fill='none' stroke='red'/>",
        ),
        (
            "<!DOCTYPE svg [<!ENTITY ns 'http://www.w3.org/2000/svg'>\
             <!ENTITY part '<path d=\"M5 5L9 9\" fill=\"none\" stroke=\"red\"/>'>]>",
            "xmlns='&ns;'",
            "&part;<g transform='translate(9 9)'>&part;</g>",
        ),
        ("", "", "<path d='M5 5L9 9' fill='none' stroke='red'/>"),
    ] {
        let text = format!("{head}<svg {attributes} viewBox='0 0 100 100'>{body}</svg>");
        let run = Run::of_text(&text, &[]);
        assert!(nearest(&run, 9.0, 9.0) <= run.number("/bound_mm"));
        assert_eq!(run.notes, [""; 0], "{head}");
    }
}

/// A drawing is fitted into the bed: how large it becomes is said, beside its own size.
#[test]
fn the_scale_is_said() {
    for (attributes, own) in [
        ("viewBox='0 0 100 100'", None),
        (
            "viewBox='0 0 100 100' width='50mm' height='50mm'",
            Some(0.5),
        ),
        ("viewBox='0 0 100 100' width='2in'", Some(0.508)),
        ("width='100pt' height='100pt'", Some(25.4 / 96.0)),
        ("width='100' height='100'", None),
    ] {
        let text = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' {attributes}>\
             <rect width='50' height='50' fill='none' stroke='red'/></svg>"
        );
        let run = Run::of_text(&text, &[]);
        // The bed is 130 mm wide.
        assert!((run.number("/mm_per_unit") - 2.6).abs() < 1e-6);
        let stated = run.report["own_mm_per_unit"].as_f64();
        assert_eq!(stated.is_some(), own.is_some(), "{attributes}");
        let line = match own {
            Some(own) => {
                assert!((stated.unwrap() - own).abs() < 1e-6 * own, "{stated:?}");
                format!(
                    "placed: a unit of the drawing is 2.6000 mm, {:.4} times its own size\n",
                    2.6 / own
                )
            }
            None => "placed: a unit of the drawing is 2.6000 mm; the file states no size in mm\n"
                .to_owned(),
        };
        assert!(run.summary.contains(&line), "{}", run.summary);
    }
}

/// One line, with what there would have been to draw.
#[test]
fn a_drawing_without_anything_to_draw_says_what_it_has() {
    let folder = tempfile::TempDir::new().unwrap();
    let svg = folder.path().join("text.svg");
    std::fs::write(
        &svg,
        "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'>\n<text>a</text>\
         <image/><path d='M0 0H9' fill='none'/></svg>",
    )
    .unwrap();
    assert_refused(
        "engrave",
        &["--svg", svg.to_str().unwrap()],
        "text.svg: there is nothing to draw: line 2, column 1: <text>: convert text to paths (1 \
         time): line 2, column 15: <image>: pictures cannot be engraved (1 time): line 2, column \
         23: <path>: hidden, or neither filled nor stroked, not engraved (1 time)",
    );
}
