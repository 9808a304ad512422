//! The glass engraver: a drawing planned and engraved, and the files that this leaves.

mod recorder;

use std::cell::RefCell;

use anyhow::{Context, Result, bail};
use engraver::{
    Drawing, Engraving, Machine, MotorController, Plan, PlanSettings, PulseLog, Report, Tolerance,
    Wires,
};
use serde::Deserialize;
use serde_json::json;

use self::recorder::Recorder;
use crate::answer::{self, Answer};
use crate::boundary::Request;
use crate::limits::{self, AxisMay, Known, RowEnd, ToolMay};
use crate::load;
use crate::progress;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Parameters {
    /// What the drawing is called in messages.
    name: String,
    svg: String,
    machine: String,
    tolerance_mm: f64,
    /// `a,b,c,d,e,f`, or fitted into the bed.
    placement: Option<String>,
    keep_order: bool,
    /// `pattern` or `timed`.
    controller: String,
}

/// What was engraved last: the files are written from it when they are asked for.
struct Engraved {
    machine: Machine,
    drawing: Drawing,
    settings: PlanSettings,
    controller: MotorController,
    plan: Plan,
    engraving: Engraving,
}

thread_local!(static LAST: RefCell<Option<Engraved>> = const { RefCell::new(None) });

/// Plans a drawing, engraves it, and gives what the page shows of it.
pub(crate) fn engrave(request: &Request) -> Result<Answer> {
    let parameters: Parameters = request.parameters()?;
    let placement = parameters.placement.map(|text| text.parse());
    let settings = PlanSettings {
        tolerance: Tolerance::from_mm(parameters.tolerance_mm).context("tolerance")?,
        placement: placement.transpose().context("placement")?,
        keep_order: parameters.keep_order,
    };
    let machine = Machine::parse(&parameters.machine).context("machine.toml")?;
    let place = || parameters.name.clone();
    let drawing = Drawing::parse(&parameters.svg).with_context(place)?;
    let plan = Plan::new(&machine, &drawing, &settings, progress::teller(0));
    let plan = plan.with_context(place)?;
    let controller = parameters.controller.parse()?;
    let mut recorder = Recorder::new(&machine);
    let engraving = play(
        (&machine, &drawing, &settings, &plan),
        controller,
        &mut recorder,
    );
    let engraving = engraving.with_context(place)?;
    let recorded = recorder.finish(engraving.shown().ticks());
    let engraved = Engraved {
        machine,
        drawing,
        settings,
        controller,
        plan,
        engraving,
    };
    let answer = recorded.add_to(engraved.answer()?);
    LAST.set(Some(engraved));
    Ok(answer)
}

fn play(
    (machine, drawing, settings, plan): (&Machine, &Drawing, &PlanSettings, &Plan),
    controller: MotorController,
    wires: &mut impl Wires,
) -> Result<Engraving> {
    let told = progress::teller(1);
    Engraving::run(machine, drawing, settings, plan, controller, wires, told)
}

impl Engraved {
    fn report(&self) -> Report<'_> {
        self.engraving
            .report(&self.machine, &self.drawing, &self.plan)
    }

    fn answer(&self) -> Result<Answer> {
        let report = self.report();
        let value = json!({
            "summary": report.to_string(),
            "report": report,
            "isWithinBound": self.engraving.is_within_bound(),
            "axesMay": self.machine.timed_limits().axes,
        });
        let mut outlines = Vec::new();
        let run = self.engraving.shown();
        for outline in run.drawing() {
            outlines.extend(outline.iter().flat_map(|point| [point.x, point.y]));
            outlines.extend([f64::NAN; 2]);
        }
        let deviation = run.deviation_over_time();
        let deviation = deviation.flat_map(|(s, mm)| [s, mm.unwrap_or(f64::NAN)]);
        let answer = Answer::new(value)?
            .with_numbers("outlines", outlines.into_iter().map(f64::to_le_bytes))
            .with_numbers("deviation", deviation.map(f64::to_le_bytes));
        let answer = load::with_torque(answer, run.torque());
        let answer = load::with_vibration(answer, "vibration", run.vibration());
        let answer = load::with_vibration(answer, "vibration unshaped", run.unshaped());
        Ok(self.with_limits(answer))
    }

    /// What limits timed strokes at any time; none of a pattern.
    fn with_limits(&self, answer: Answer) -> Answer {
        let machine = &self.machine;
        let limits = machine.timed_limits();
        let rows = self.engraving.shown().rows();
        let rows: Vec<_> = rows
            .iter()
            .map(|row| RowEnd {
                time_s: row.time_s,
                position: row.position_rad,
                velocity: row.velocity_rad_s,
                source: row.stroke,
                tool: ToolMay {
                    feed: limits.feed_mm_s,
                    acceleration: limits.acceleration_mm_s2,
                },
                is_first: row.is_first,
            })
            .collect();
        let axes = limits.axes.map(|(speed, acceleration)| AxisMay {
            speed,
            acceleration,
        });
        let place = |position| Some(machine.tool_at(position));
        // Shaped along its curves, the tool keeps its own limits too.
        let known = Known {
            shaping_s: 0.0,
            torque: self.engraving.shown().torque(),
        };
        limits::add_to(answer, &rows, axes, known, place)
    }
}

/// A file of what was engraved last, by its name.
pub(crate) fn file(request: &Request) -> Result<Answer> {
    let name: String = request.parameters()?;
    LAST.with_borrow(|last| {
        let last = last.as_ref().context("nothing has been engraved yet")?;
        match &*name {
            "pattern.bin" => answer::file(last.plan.pattern()),
            "pattern.h" => answer::file(engraver::header(&last.machine, &last.plan)?),
            "engraved.svg" => answer::file(last.engraving.shown().picture().to_string()),
            "report.json" => answer::json_file(&last.report()),
            "pulses.vcd" => answer::file(last.pulses()?),
            _ => bail!("there is no file {name:?}"),
        }
    })
}

impl Engraved {
    /// The pins over time: all is played once more.
    fn pulses(&self) -> Result<Vec<u8>> {
        let mut bytes = Vec::new();
        let mut log = PulseLog::new(&mut bytes, &self.machine)?;
        let all = (&self.machine, &self.drawing, &self.settings, &self.plan);
        let engraving = play(all, self.controller, &mut log)?;
        log.finish(engraving.shown().ticks())?;
        Ok(bytes)
    }
}
