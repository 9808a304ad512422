//! The two-axis stage: G-code run in a closed loop and without, and the files that this leaves.

use std::cell::RefCell;

use anyhow::{Context, Result, bail, ensure};
use serde::Deserialize;
use serde_json::json;
use stage::{Machine, Program, Report, Run, Seen, Settings, StepLog, run, switches_mm};

use crate::answer::{self, Answer};
use crate::boundary::Request;
use crate::limits::{self, AxisMay, Known, RowEnd, ToolMay};
use crate::load;
use crate::progress;

/// What a page runs at most: a step costs up to 50 bytes and a microsecond.
const MAX_STEPS: f64 = 2e7;
/// Points of a picture that a browser draws in a frame.
const MAX_POINTS: usize = 40_000;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Parameters {
    /// What the program is called in messages.
    name: String,
    gcode: String,
    machine: String,
    stepping: String,
    tolerance_mm: f64,
    /// A fraction.
    lose_steps: f64,
    seed: u64,
}

/// A program that is not run.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Preview {
    name: String,
    gcode: String,
}

/// What was run last: the files are written from it when they are asked for.
struct Ran {
    machine: Machine,
    program: Program,
    settings: Settings,
    run: Run,
}

thread_local!(static LAST: RefCell<Option<Ran>> = const { RefCell::new(None) });

/// The lines and arcs of a program, before any of it is run.
pub(crate) fn preview(request: &Request) -> Result<Answer> {
    let Preview { name, gcode } = request.parameters()?;
    let program = read(&name, &gcode)?;
    let value = json!({ "switchesMm": switches_mm(), "steps": program.steps() });
    Ok(Answer::new(value)?.with_rows("programmed", programmed(program.points())))
}

/// The program as telegrams of a board, each with its line, and where the first one begins and each
/// ends, in mm.
pub(crate) fn telegrams(request: &Request) -> Result<Answer> {
    let Preview { name, gcode } = request.parameters()?;
    let program = read(&name, &gcode)?;
    let lines: Vec<_> = program.line_numbers().collect();
    let telegrams: Vec<_> = program.telegrams().collect();
    let ends: Vec<_> = program.ends().collect();
    Answer::new(json!({ "lines": lines, "telegrams": telegrams, "ends": ends }))
}

fn read(name: &str, gcode: &str) -> Result<Program> {
    let program = Program::parse(gcode).with_context(|| name.to_owned())?;
    let steps = program.steps();
    ensure!(
        steps <= MAX_STEPS,
        "{name}: {steps:.0} steps, and this page runs {MAX_STEPS:.0} at most: \
         the command line has no such limit (cargo run --release --example stage -- --gcode {name})"
    );
    Ok(program)
}

/// Runs a program, and gives what the page shows of it.
pub(crate) fn stage(request: &Request) -> Result<Answer> {
    let parameters: Parameters = request.parameters()?;
    let settings = Settings {
        stepping: parameters.stepping.parse()?,
        tolerance_mm: parameters.tolerance_mm,
        lose_steps: parameters.lose_steps,
        seed: parameters.seed,
    };
    let machine = Machine::parse(&parameters.machine).context("machine.toml")?;
    let program = read(&parameters.name, &parameters.gcode)?;
    // What was run before makes room.
    LAST.set(None);
    let mut told = progress::teller(0);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "within MAX_STEPS"
    )]
    let (mut done, all) = (0, program.steps() as u64);
    let run = run(&machine, &program, &settings, &mut |_, _| {
        done += 1;
        told(done, all);
        Ok(())
    });
    let run = run.with_context(|| parameters.name.clone())?;
    let ran = Ran {
        machine,
        program,
        settings,
        run,
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
            [
                line as f64,
                f64::from(u8::from(leg.is_rapid)),
                leg.feed_mm_s,
            ]
        });
        let value = json!({
            "summary": report.to_string(),
            "report": report,
            "switchesMm": switches_mm(),
            "axesMay": self.run.axes_may(),
        });
        let (closed, open) = (self.run.closed_loop(), self.run.open_loop());
        let answer = Answer::new(value)?
            .with_rows("legs", legs)
            .with_rows("programmed", programmed(self.run.programmed()))
            .with_rows("closed", path(closed))
            .with_rows("open", path(open))
            .with_rows("closed deviations", closed.deviations())
            .with_rows("open deviations", open.deviations())
            .with_rows("corrections", self.run.corrections())
            .with_rows("speeds", self.run.speeds())
            .with_rows("accelerations", self.run.axis_accelerations());
        let mut answer = load::with_torque(answer, self.run.torque());
        let names = [
            ["vibration x", "vibration x unshaped"],
            ["vibration y", "vibration y unshaped"],
        ];
        for ([shaped, plain], (swings, unshaped)) in names
            .into_iter()
            .zip(self.run.vibration().into_iter().flatten())
        {
            answer = load::with_vibration(answer, shaped, Some(swings));
            answer = load::with_vibration(answer, plain, unshaped);
        }
        Ok(self.with_limits(answer))
    }

    /// What limits timed steps at any time; a leg is the source of a row.
    fn with_limits(&self, answer: Answer) -> Answer {
        let rows: Vec<_> = (0_u32..)
            .zip(self.run.rows())
            .map(|(number, row)| RowEnd {
                time_s: row.time_s,
                position: row.position_mm,
                velocity: row.velocity_mm_s,
                source: row.motion,
                tool: ToolMay {
                    feed: row.feed_mm_s,
                    acceleration: None,
                },
                is_first: number == 0,
            })
            .collect();
        let axes = self.run.axes_may().map(|[speed, acceleration]| AxisMay {
            speed,
            acceleration,
        });
        let known = Known {
            shaping_s: self.run.shaping_s(),
            torque: self.run.torque(),
        };
        limits::add_to(answer, &rows, axes, known, |[x, y]| Some([x, y, 0.0]))
    }

    /// The steps of the path: all is run once more.
    fn steps(&self) -> Result<Vec<u8>> {
        let mut steps = Vec::new();
        let mut log = StepLog::new(&mut steps)?;
        run(
            &self.machine,
            &self.program,
            &self.settings,
            &mut |ticks, by| log.step(ticks, by),
        )?;
        log.finish()?;
        Ok(steps)
    }
}

/// Every so many of a list, so that there are not too many.
fn stride(count: usize) -> usize {
    count.div_ceil(MAX_POINTS).max(1)
}

/// X and Y of lines and arcs; no number after each, unless there are so many that they are one
/// line.
fn programmed(motions: impl Iterator<Item = Vec<[f64; 2]>>) -> Vec<[f64; 2]> {
    let motions: Vec<_> = motions.collect();
    let step = stride(motions.iter().map(Vec::len).sum());
    if step > 1 {
        return motions.into_iter().flatten().step_by(step).collect();
    }
    let ended = motions.into_iter().map(|mut points| {
        points.push([f64::NAN; 2]);
        points
    });
    ended.flatten().collect()
}

/// Seconds, X and Y of a stage, and the leg; as many as can be drawn.
fn path(seen: &Seen) -> impl Iterator<Item = [f64; 4]> {
    let legs = seen.legs();
    let step = stride(legs.iter().map(|leg| leg.points.len()).sum());
    let points = (0_u32..).zip(legs).flat_map(|(number, leg)| {
        let points = leg.points.iter();
        points.map(move |[s, x, y]| [*s, *x, *y, f64::from(number)])
    });
    let last = legs.last().and_then(|leg| leg.points.last());
    let last = last.map(|[s, x, y]| [*s, *x, *y, legs.len() as f64 - 1.0]);
    points.step_by(step).chain(last)
}

/// A file of what was run last, by its name.
pub(crate) fn file(request: &Request) -> Result<Answer> {
    let name: String = request.parameters()?;
    LAST.with_borrow(|last| {
        let last = last.as_ref().context("nothing has been run yet")?;
        match &*name {
            "steps.csv" => answer::file(last.steps()?),
            "stage.svg" => answer::file(last.run.picture().to_string()),
            "report.json" => answer::json_file(&last.report()),
            _ => bail!("there is no file {name:?}"),
        }
    })
}
