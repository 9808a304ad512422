//! The alignment platform: a body aligned by an operator, and a pendant for the page's own hands.

use std::cell::RefCell;

use anyhow::{Context, Result, bail, ensure};
use handwheel::{Key, LedState, Position};
use platform::{Alignment, Desk, Hand, Machine, Mode, PlatformAt, Pose, Run, run};
use serde::Deserialize;
use serde_json::{Value, json};

use crate::answer::{self, Answer};
use crate::boundary::Request;

/// Time that passes at a desk from one look to the next, at most.
const MAX_WAIT_MS: u64 = 60_000;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Parameters {
    platform: String,
    /// As in the platform file, unless given.
    to: Option<Pose>,
    mode: String,
}

/// What a hand does at the pendant.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
enum Act {
    /// 0 releases all.
    Key(u8),
    Direction(u8),
    Multiplier(u8),
    Enable([bool; 2]),
    Wheel(i32),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Turn {
    acts: Vec<Act>,
    wait_ms: u64,
}

/// What was aligned last: the files are written from it when they are asked for.
struct Aligned {
    mode: Mode,
    run: Run,
}

thread_local! {
    static LAST: RefCell<Option<Aligned>> = const { RefCell::new(None) };
    static DESK: RefCell<Option<Desk>> = const { RefCell::new(None) };
}

fn machine(text: &str) -> Result<Machine> {
    Machine::parse(text).context("platform.toml")
}

/// Aligns the body, and gives what the page shows of it.
pub(crate) fn align(request: &Request) -> Result<Answer> {
    let parameters: Parameters = request.parameters()?;
    let machine = machine(&parameters.platform)?;
    let mode = match &*parameters.mode {
        "pvt" => Mode::Pvt,
        "pt" => Mode::Pt,
        other => bail!("there is no table {other:?}: pvt, pt"),
    };
    let [from, to] = machine.poses();
    let to = parameters.to.unwrap_or(to);
    let alignment = Alignment {
        from: Some(from),
        to: Some(to),
        mode,
    };
    // A wire that brings every byte to the other end.
    let run = run(&machine, &alignment, &mut |_, byte| Ok(byte))?;
    let report = run.report();
    let value = json!({
        "summary": report.to_string(),
        "report": report,
        "isWithinBounds": report.is_within_bounds(),
        "note": run.note(),
        "from": from,
        "to": to,
        "moments": run.moments().iter().map(moment).collect::<Vec<_>>(),
    });
    let answer = Answer::new(value)?;
    LAST.set(Some(Aligned { mode, run }));
    Ok(answer)
}

fn moment(at: &PlatformAt) -> Value {
    json!({
        "s": at.time_s,
        "locators": at.locators_mm,
        "speeds": at.speeds_mm_s,
        "error": at.distance_error_mm,
        "outline": at.outline_mm,
    })
}

/// A file of what was aligned last, by its name.
pub(crate) fn file(request: &Request) -> Result<Answer> {
    let name: String = request.parameters()?;
    LAST.with_borrow(|last| {
        let Aligned { mode, run } = last.as_ref().context("nothing has been aligned yet")?;
        match &*name {
            "line.log" => answer::file(run.line_log()),
            "jog.svg" => answer::file(run.jog_picture().to_string()),
            "align.svg" => answer::file(run.align_picture().to_string()),
            "report.json" => answer::json_file(run.report()),
            table if table == mode.file() => answer::file(run.table()),
            _ => bail!("there is no file {name:?}"),
        }
    })
}

/// A platform with its pendant switched on, in place of the one before.
pub(crate) fn begin(request: &Request) -> Result<Answer> {
    let platform: String = request.parameters()?;
    let desk = Desk::new(&machine(&platform)?)?;
    let answer = seen(&desk);
    DESK.set(Some(desk));
    answer
}

/// Does something at the pendant and lets time pass.
pub(crate) fn turn(request: &Request) -> Result<Answer> {
    let Turn { acts, wait_ms } = request.parameters()?;
    ensure!(
        wait_ms <= MAX_WAIT_MS,
        "{wait_ms} ms are above {MAX_WAIT_MS}"
    );
    DESK.with_borrow_mut(|desk| {
        let desk = desk.as_mut().context("no pendant is switched on")?;
        for act in acts {
            desk.act(act.hand()?)?;
        }
        desk.wait_ms(wait_ms)?;
        seen(desk)
    })
}

impl Act {
    fn hand(self) -> Result<Hand> {
        Ok(match self {
            Self::Key(0) => Hand::Key(None),
            Self::Key(key) => Hand::Key(Some(Key::new(key)?)),
            Self::Direction(position) => Hand::Direction(Position::new(position)?),
            Self::Multiplier(position) => Hand::Multiplier(Position::new(position)?),
            Self::Enable([left, right]) => Hand::Enable { left, right },
            Self::Wheel(counts) => Hand::Wheel(counts),
        })
    }
}

fn seen(desk: &Desk) -> Result<Answer> {
    let seen = desk.seen()?;
    let led = match seen.led {
        LedState::Off => "off",
        LedState::On => "on",
        LedState::Flashing => "flashing",
    };
    Answer::new(json!({
        "display": seen.display,
        "led": led,
        "isMoving": seen.is_moving,
        "moment": moment(&seen.platform),
    }))
}
