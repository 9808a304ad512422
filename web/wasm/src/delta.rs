//! The Delta robot: lines answered, planned and driven, and the files that this leaves.

use std::cell::RefCell;

use anyhow::{Context, Result, bail, ensure};
use delta::{ArmsAt, Machine, Record, Report, Session, StepLog, drive, simulate};
use known_load::{TorqueUsed, Vibration};
use serde::Deserialize;
use serde_json::json;

use crate::answer::{self, Answer};
use crate::boundary::Request;
use crate::limits::{self, AxisMay, Known, RowEnd, ToolMay};
use crate::load;

/// Points of an outline of the workspace.
const OUTLINE: u32 = 72;
/// Heights at which the workspace is cut, from the home position to the lowest point of the path.
const SLICES: u32 = 4;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Parameters {
    lines: String,
    machine: String,
    motion: String,
    /// On the platform.
    load_kg: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Calibration {
    machine: String,
    measured: String,
    fit: String,
}

/// What was driven last: the files are written from it when they are asked for.
struct Driven {
    machine: Machine,
    record: Record,
    steps: Vec<u8>,
    /// What the other ways make of the lines, when it has been asked for.
    compared: Option<Compared>,
}

struct Compared {
    report: Report,
    /// As text.
    picture: String,
    /// How the tool swings without shaping.
    unshaped: Option<Vibration>,
}

thread_local!(static LAST: RefCell<Option<Driven>> = const { RefCell::new(None) });

/// Drives the lines of an input, and gives what the page shows of it.
pub(crate) fn delta(request: &Request) -> Result<Answer> {
    let parameters: Parameters = request.parameters()?;
    let machine = Machine::parse(&parameters.machine).context("machine.toml")?;
    let mut log = StepLog::new(Vec::new())?;
    let mut observer = |ticks, steps| log.step(ticks, steps);
    let mut session = Session::new(&machine, parameters.motion.parse()?, &mut observer)?;
    let mut answers = Vec::new();
    for byte in parameters.lines.bytes() {
        answers.extend(session.handle_byte(byte)?);
    }
    answers.extend(session.handle_end()?);
    let record = session.finish()?;
    ensure!(
        !answers.is_empty(),
        "there is no point to drive to: a line has x y z in mm"
    );
    let steps = log.finish()?;
    let driven = Driven {
        machine,
        record,
        steps,
        compared: None,
    };
    let answer = driven.answer(&answers, parameters.load_kg)?;
    LAST.set(Some(driven));
    Ok(answer)
}

impl Driven {
    fn answer(&self, answers: &[String], load_kg: f64) -> Result<Answer> {
        let (machine, record) = (&self.machine, &self.record);
        let drive = drive(machine, record, &*self.steps)?;
        let arms = machine.geometry().arms().iter().map(|arm| {
            json!({ "azimuthRad": arm.azimuth, "baseMm": arm.base, "platformMm": arm.platform })
        });
        let [max_rate, max_acceleration] = machine.max_rate_and_acceleration();
        let value = json!({
            "answers": answers,
            "refused": record.check().err().map(|it| it.to_string()),
            "refusedLines": record.refused_lines().collect::<Vec<_>>(),
            "notes": record.notes(),
            "durationS": drive.duration_s(),
            "maxPathErrorMm": drive.max_path_error_mm(),
            "arms": arms.collect::<Vec<_>>(),
            "maxRateDegS": max_rate,
            "maxAccelerationDegS2": max_acceleration,
        });
        let moments = drive.arms(load_kg)?;
        let lines = drive
            .lines()
            .map(|([[a, b, c], [x, y, z]], feed, end_s)| [a, b, c, x, y, z, feed, end_s]);
        let answer = Answer::new(value)?
            .with_rows("arms", moments.iter().map(row))
            .with_rows("lines", lines)
            .with_rows("speeds", drive.speeds())
            .with_rows("workspace", self.workspace(&moments));
        let answer = load::with_torque(answer, drive.torque());
        let answer = load::with_vibration(answer, "vibration", drive.vibration());
        Ok(self.with_limits(answer, drive.torque()))
    }

    /// What limits the rounded lines at any time; none of lines that are run one by one.
    fn with_limits(&self, answer: Answer, torque: Option<&TorqueUsed<3>>) -> Answer {
        let (machine, record) = (&self.machine, &self.record);
        let rows: Vec<_> = (0_u32..)
            .zip(record.rows())
            .map(|(number, row)| RowEnd {
                time_s: row.time_s,
                position: row.position_rad,
                velocity: row.velocity_rad_s,
                source: row.line,
                tool: ToolMay {
                    feed: row.feed_mm_s,
                    acceleration: row.acceleration_mm_s2,
                },
                is_first: number == 0,
            })
            .collect();
        let [speed, acceleration] = machine.max_rate_and_acceleration().map(f64::to_radians);
        let axes = [AxisMay {
            speed,
            acceleration,
        }; 3];
        let place = |angles: [f64; 3]| Some(machine.geometry().forward(angles).ok()?.into());
        let known = Known {
            shaping_s: record.shaping_s(),
            torque,
        };
        limits::add_to(answer, &rows, axes, known, place)
    }

    /// The lines are driven in the other ways too.
    fn compared(&mut self) -> Result<&Compared> {
        let compared = match self.compared.take() {
            Some(compared) => compared,
            None => {
                let run = simulate(&self.machine, &self.record, &*self.steps)?;
                Compared {
                    report: run.report(),
                    picture: run.picture()?.to_string(),
                    unshaped: run.unshaped().cloned(),
                }
            }
        };
        Ok(self.compared.insert(compared))
    }

    /// Outlines around the heights of a path; no number after each. Those that there are not are
    /// left out.
    fn workspace(&self, moments: &[ArmsAt]) -> Vec<[f64; 3]> {
        let heights = moments.iter().map(|it| it.platform_mm[2]);
        let lowest = heights.clone().fold(f64::INFINITY, f64::min);
        let highest = heights.fold(f64::NEG_INFINITY, f64::max);
        let geometry = self.machine.geometry();
        let mut points = Vec::new();
        for slice in 0..SLICES {
            let part = f64::from(slice) / f64::from(SLICES - 1);
            let z = highest + (lowest - highest) * part;
            points.extend(geometry.horizontal_slice(z, OUTLINE).ok().map(closed));
        }
        let centre = f64::midpoint(highest, lowest);
        for azimuth in [0.0, core::f64::consts::FRAC_PI_2] {
            let slice = geometry.vertical_slice(azimuth, centre, OUTLINE);
            points.extend(slice.ok().map(closed));
        }
        points.concat()
    }
}

/// A line that ends where it begins, then no number.
fn closed(points: impl Iterator<Item = impl Into<[f64; 3]>>) -> Vec<[f64; 3]> {
    let mut points: Vec<[f64; 3]> = points.map(Into::into).collect();
    points.extend(points.first().copied());
    points.push([f64::NAN; 3]);
    points
}

/// Seconds; angles, rates, accelerations and torques of the arms; platform; elbows.
fn row(it: &ArmsAt) -> [f64; 25] {
    let mut row = [it.t_s; 25];
    let values = [
        it.angles_deg,
        it.rates_deg_s,
        it.accelerations_deg_s2,
        it.torques_nm,
        it.platform_mm,
    ];
    let values = values.iter().chain(&it.elbows_mm).flatten();
    for (cell, value) in row.iter_mut().skip(1).zip(values) {
        *cell = *value;
    }
    row
}

/// Calibrates a machine by measured points: what was found, and the machine file with it.
pub(crate) fn calibrate(request: &Request) -> Result<Answer> {
    let parameters: Calibration = request.parameters()?;
    let machine = Machine::parse(&parameters.machine).context("machine.toml")?;
    let found = machine.calibrate(&parameters.measured, parameters.fit.parse()?)?;
    Answer::new(json!({
        "summary": found.to_string(),
        "machine": found.machine_file(&parameters.machine)?,
    }))
}

fn with_last<T>(take: impl FnOnce(&mut Driven) -> Result<T>) -> Result<T> {
    LAST.with_borrow_mut(|last| take(last.as_mut().context("nothing has been driven yet")?))
}

/// The summary of what was driven last, with what the other ways make of the lines, and how its
/// tool swings without shaping.
pub(crate) fn report() -> Result<Answer> {
    with_last(|last| {
        let compared = last.compared()?;
        let answer = Answer::new(compared.report.to_string())?;
        let unshaped = compared.unshaped.as_ref();
        Ok(load::with_vibration(answer, "vibration unshaped", unshaped))
    })
}

/// A file of what was driven last, by its name.
pub(crate) fn file(request: &Request) -> Result<Answer> {
    let name: String = request.parameters()?;
    with_last(|last| match &*name {
        "steps.csv" => answer::file(&*last.steps),
        "delta.svg" => answer::file(&*last.compared()?.picture),
        "report.json" => answer::json_file(&last.compared()?.report),
        _ => bail!("there is no file {name:?}"),
    })
}
