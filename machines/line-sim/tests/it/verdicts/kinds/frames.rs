//! Sides, and taps, whose characters are made otherwise: baud rate and parity.

use line_sim::{Frame, Parity};
use monitor3964r::{BaudRatio, Diagnosis, Side, Verdict};

use super::Example;
use crate::verdicts::case::{Case, pick};

fn frame(baud: u32, parity: Parity) -> Frame {
    Frame::new(baud, parity).unwrap()
}

fn with_frame(
    case: Case,
    other: Frame,
    is_right: impl Fn(Side, &Diagnosis) -> bool + 'static,
) -> Example {
    // A side without telegrams shows a missing parity bit to nobody.
    let case = Case {
        sends: [true, case.sends[1]],
        ..case
    };
    let [mut faulty, partner] = case.plans();
    faulty.settings.frame = other;
    Example::new(&case, [faulty, partner], move |found| {
        is_right(case.faulty, found)
    })
}

/// A missing parity bit shows as such where STX, DLE and NAK mostly stand alone.
pub(crate) fn no_parity(case: Case) -> Example {
    with_frame(
        case,
        frame(9600, Parity::None),
        |side, found| matches!(found.verdict, Verdict::NoParity { side: it } | Verdict::Garbage { side: it } if it == side),
    )
}

pub(crate) fn odd_parity(case: Case) -> Example {
    with_frame(
        case,
        frame(9600, Parity::Odd),
        |side, found| matches!(found.verdict, Verdict::OtherParity { side: it } | Verdict::Garbage { side: it } if it == side),
    )
}

/// Baud rates and parities, and what the tap may say of the rate.
fn rates(case: &Case) -> (Frame, [BaudRatio; 2]) {
    let mut random = case.random();
    let parity = *pick(&mut random, &[Parity::Even, Parity::Odd, Parity::None]);
    let (baud, ratios) = *pick(
        &mut random,
        &[
            (38_400, [BaudRatio::DoubleOrMore; 2]),
            (19_200, [BaudRatio::Double, BaudRatio::DoubleOrMore]),
            (4800, [BaudRatio::Half; 2]),
            (2400, [BaudRatio::Quarter; 2]),
            (1200, [BaudRatio::Eighth; 2]),
        ],
    );
    (frame(baud, parity), ratios)
}

/// Never another ratio than the true one.
pub(crate) fn another_rate(case: Case) -> Example {
    let (frame, ratios) = rates(&case);
    with_frame(case, frame, move |wrong, found| match found.verdict {
        Verdict::Garbage { side } => side == wrong,
        Verdict::OtherRate { side, ratio } => side == wrong && ratios.contains(&ratio),
        _ => false,
    })
}

/// The ratio is told, not only that there is one.
pub(crate) fn the_ratio_of_a_rate(case: Case) -> Example {
    let (frame, ratios) = rates(&case);
    with_frame(
        case,
        frame,
        move |_, found| matches!(found.verdict, Verdict::OtherRate { ratio, .. } if ratios.contains(&ratio)),
    )
}

/// Both sides agree, the tap does not.
pub(crate) fn another_rate_of_the_tap(case: Case) -> Example {
    let (frame, ratios) = rates(&case);
    let plans = case.plans().map(|mut plan| {
        plan.settings.frame = frame;
        plan
    });
    Example::new(&case, plans, move |found| match found.verdict {
        Verdict::BothGarbage => true,
        Verdict::TapRate { ratio } => ratios.contains(&ratio),
        _ => false,
    })
}

pub(crate) fn another_parity_of_the_tap(case: Case) -> Example {
    let mut random = case.random();
    let parity = *pick(&mut random, &[Parity::Odd, Parity::None]);
    let plans = case.plans().map(|mut plan| {
        plan.settings.frame = frame(9600, parity);
        plan
    });
    Example::new(&case, plans, move |found| match found.verdict {
        Verdict::TapParity | Verdict::BothGarbage => true,
        // Of the one that only answers too little is heard, or nothing wrong.
        Verdict::NoParity { .. } | Verdict::OtherParity { .. } | Verdict::Garbage { .. } => {
            case.sends != [true, true]
        }
        _ => false,
    })
}
