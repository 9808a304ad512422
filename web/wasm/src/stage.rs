//! The two-axis stage: G-code run in a closed loop and without, and the files that this leaves.

use std::cell::RefCell;

use anyhow::{Context, Result, bail};
use serde::Deserialize;
use serde_json::json;
use stage::{ACCELERATION_MM_S2, Program, Report, Run, Seen, Settings, StepLog, run, switches_mm};

use crate::answer::{self, Answer};
use crate::boundary::Request;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Parameters {
    /// What the program is called in messages.
    name: String,
    gcode: String,
    stepping: String,
    tolerance_mm: f64,
    /// A fraction.
    lose_steps: f64,
    seed: u64,
}

/// What was run last: the files are written from it when they are asked for.
struct Ran {
    program: Program,
    run: Run,
    steps: Vec<u8>,
}

thread_local!(static LAST: RefCell<Option<Ran>> = const { RefCell::new(None) });

/// Runs a program, and gives what the page shows of it.
pub(crate) fn stage(request: &Request) -> Result<Answer> {
    let parameters: Parameters = request.parameters()?;
    let settings = Settings {
        stepping: parameters.stepping.parse()?,
        tolerance_mm: parameters.tolerance_mm,
        lose_steps: parameters.lose_steps,
        seed: parameters.seed,
    };
    let place = || parameters.name.clone();
    let program = Program::parse(&parameters.gcode).with_context(place)?;
    let mut steps = Vec::new();
    let mut log = StepLog::new(&mut steps)?;
    let run = run(&program, &settings, &mut |ticks, by| log.step(ticks, by));
    let run = run.with_context(place)?;
    log.finish()?;
    let ran = Ran {
        program,
        run,
        steps,
    };
    let answer = ran.answer()?;
    LAST.set(Some(ran));
    Ok(answer)
}

impl Ran {
    fn report(&self) -> Report {
        self.run.report().with_notes(self.program.notes())
    }

    fn answer(&self) -> Result<Answer> {
        let report = self.report();
        let legs = self.run.closed_loop().legs().iter();
        let legs = legs.zip(self.program.line_numbers()).map(|(leg, line)| {
            json!({ "line": line, "isRapid": leg.is_rapid, "feedMmS": leg.feed_mm_s })
        });
        let value = json!({
            "summary": report.to_string(),
            "report": report,
            "legs": legs.collect::<Vec<_>>(),
            "switchesMm": switches_mm(),
            "accelerationMmS2": ACCELERATION_MM_S2,
        });
        let programmed = self.run.programmed().flat_map(|mut points| {
            points.push([f64::NAN; 2]);
            points
        });
        let (closed, open) = (self.run.closed_loop(), self.run.open_loop());
        Ok(Answer::new(value)?
            .with_rows("programmed", programmed)
            .with_rows("closed", path(closed))
            .with_rows("open", path(open))
            .with_rows("closed deviations", closed.deviations())
            .with_rows("open deviations", open.deviations())
            .with_rows("corrections", self.run.corrections())
            .with_rows("speeds", self.run.speeds())
            .with_rows("accelerations", self.run.axis_accelerations()))
    }
}

/// Seconds, X and Y of a stage; no number after each leg.
fn path(seen: &Seen) -> impl Iterator<Item = [f64; 3]> {
    let legs = seen.legs().iter();
    legs.flat_map(|leg| leg.points.iter().copied().chain([[f64::NAN; 3]]))
}

/// A file of what was run last, by its name.
pub(crate) fn file(request: &Request) -> Result<Answer> {
    let name: String = request.parameters()?;
    LAST.with_borrow(|last| {
        let last = last.as_ref().context("nothing has been run yet")?;
        match &*name {
            "steps.csv" => answer::file(&*last.steps),
            "stage.svg" => answer::file(last.run.picture().to_string()),
            "report.json" => answer::json_file(&last.report()),
            _ => bail!("there is no file {name:?}"),
        }
    })
}
