//! The numbers of a run, for programs and for people.

use core::fmt;

use known_load::{TorqueReport, VibrationReport};
use pattern_codec::engraving::{ByteOrder, PerAxis};
use serde::Serialize;

use crate::drawing::Drawing;
use crate::machine::{Machine, Settings};
use crate::motors::FollowedAxes;
use crate::plan::Plan;
use crate::simulation::Run;
use crate::tool_speed::Spread;

/// `report.json`; displayed, a summary in lines.
#[derive(Debug, Clone, Serialize)]
pub struct Report<'a> {
    /// a b c d e f, from the drawing's user units to machine mm:
    /// x' = ax + cy + e, y' = bx + dy + f.
    placement: [f64; 6],
    mm_per_unit: f64,
    /// The same by the size that the drawing's file states.
    #[serde(skip_serializing_if = "Option::is_none")]
    own_mm_per_unit: Option<f64>,
    /// What the drawing shows and is not engraved, or otherwise.
    notes: &'a [String],
    machine: MachineReport<'a>,
    strokes: usize,
    length_mm: f64,
    /// Of the lifted tool, in straight lines from home over all strokes and back.
    travel_mm: f64,
    records: u64,
    fast_records: u64,
    slow_records: u64,
    bytes: u64,
    pulses: PerAxis<u64>,
    end_position: PerAxis<i32>,
    duration_s: f64,
    /// Of strokes, with the tool at full depth.
    in_glass_s: f64,
    /// Of this, the disc turns and the tool stands.
    dwell_s: f64,
    /// Min and max mean speed of the tool in a record that moves the arms.
    tool_speed_mm_s: Option<[f64; 2]>,
    /// The tool's over each 4 mm of its path in the glass, the disc's turns included.
    #[serde(skip_serializing_if = "Option::is_none")]
    speed_over_4_mm: Option<Spread>,
    tolerance_mm: f64,
    max_deviation_mm: f64,
    rms_deviation_mm: f64,
    path_to_drawing_mm: f64,
    drawing_to_path_mm: f64,
    missing_mm: f64,
    bound_mm: f64,
    /// Start speeds, speed jumps and accelerations by the edges alone; a simulated motor that is
    /// given them loses steps where torque or inertia are overrun.
    motors: FollowedAxes,
    /// The same drawing by timed strokes.
    #[serde(skip_serializing_if = "Option::is_none")]
    timed: Option<TimedReport>,
}

/// What timed strokes made of the drawing.
#[derive(Debug, Clone, Serialize)]
struct TimedReport {
    pulses: PerAxis<u64>,
    end_position: PerAxis<i32>,
    duration_s: f64,
    in_glass_s: f64,
    speed_over_4_mm: Option<Spread>,
    max_deviation_mm: f64,
    rms_deviation_mm: f64,
    missing_mm: f64,
    bound_mm: f64,
    motors: FollowedAxes,
    /// What is asked of the motors, where load and torque are known.
    #[serde(skip_serializing_if = "Option::is_none")]
    torque: Option<TorqueReport>,
    /// How the tool swings, where its mode is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    vibration: Option<VibrationReport>,
}

/// As reports and charts name them.
pub(crate) const AXES: [&str; 3] = ["shoulder", "elbow", "disc"];

#[derive(Debug, Clone, Serialize)]
struct MachineReport<'a> {
    upper_mm: f64,
    fore_mm: f64,
    rad_per_pulse: Joints,
    home_rad: Joints,
    mm_per_vertical_pulse: f64,
    lift_pulses: i32,
    axis_codes: PerAxis<u8>,
    byte_order: ByteOrder,
    direction_bit: &'a str,
    half_period_ticks: u64,
    tick_ns: f64,
    settings: &'a Settings,
}

/// Angles of the forearm against the upper arm, the upper arm against the body, the disc against
/// the forearm.
#[derive(Debug, Clone, Serialize)]
struct Joints {
    elbow: f64,
    shoulder: f64,
    disc: f64,
}

impl<'a> Report<'a> {
    /// The numbers of a run.
    #[must_use]
    pub fn new(machine: &'a Machine, drawing: &'a Drawing, plan: &Plan, run: &Run) -> Self {
        let deviation = &run.deviation;
        Self {
            placement: plan.placement.0.as_coeffs(),
            mm_per_unit: plan.placement.mm_per_unit(),
            own_mm_per_unit: drawing.own_mm_per_unit(),
            notes: drawing.notes(),
            machine: MachineReport::new(machine),
            strokes: plan.reference().outlines.len(),
            length_mm: plan.length_mm,
            travel_mm: plan.travel_mm,
            records: run.records,
            fast_records: plan.statistics.fast_records,
            slow_records: plan.statistics.slow_records,
            bytes: plan.statistics.bytes(),
            pulses: run.pulses,
            end_position: run.end,
            duration_s: run.duration_s,
            in_glass_s: run.tool_speed.in_glass_s,
            dwell_s: run.tool_speed.dwell_s,
            tool_speed_mm_s: run.tool_speed.range_mm_s,
            speed_over_4_mm: run.spread,
            tolerance_mm: plan.reference().tolerance_mm,
            max_deviation_mm: run.max_deviation_mm(),
            rms_deviation_mm: deviation.rms_mm,
            path_to_drawing_mm: deviation.path_to_drawing_mm,
            drawing_to_path_mm: deviation.drawing_to_path_mm,
            missing_mm: deviation.missing_mm,
            bound_mm: plan.reference().bound_mm(),
            motors: run.motors,
            timed: None,
        }
    }

    /// The report with the same drawing by timed strokes.
    #[must_use]
    pub fn with_timed(mut self, machine: &Machine, run: &Run) -> Self {
        self.timed = Some(TimedReport {
            pulses: run.pulses,
            end_position: run.end,
            duration_s: run.duration_s,
            in_glass_s: run.tool_speed.in_glass_s,
            speed_over_4_mm: run.spread,
            max_deviation_mm: run.max_deviation_mm(),
            rms_deviation_mm: run.deviation.rms_mm,
            missing_mm: run.deviation.missing_mm,
            bound_mm: run.bound_mm,
            motors: run.motors,
            torque: run.torque.as_ref().map(|used| {
                let [x, y, _] = machine.tool_at(used.position_at_most());
                TorqueReport::new(used, AXES, [x, y])
            }),
            vibration: run.vibration.as_ref().map(|vibration| {
                VibrationReport::new("the tool", vibration, run.unshaped.as_ref())
            }),
        });
        self
    }

    /// Both ways to engrave beside each other.
    fn write_comparison(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(timed) = &self.timed else {
            return Ok(());
        };
        writeln!(f, "pattern and timed strokes:")?;
        let mut line = |name: &str, pattern: f64, timed: f64, unit: &str| {
            writeln!(f, "  {name:<28} {pattern:>8.3} {timed:>8.3} {unit}")
        };
        line("whole time", self.duration_s, timed.duration_s, "s")?;
        line("in the glass", self.in_glass_s, timed.in_glass_s, "s")?;
        if let (Some(a), Some(b)) = (self.speed_over_4_mm, timed.speed_over_4_mm) {
            line("speed over 4 mm, mean", a.mean_mm_s, b.mean_mm_s, "mm/s")?;
            line("least", a.min_mm_s, b.min_mm_s, "mm/s")?;
            line("most", a.max_mm_s, b.max_mm_s, "mm/s")?;
            let (a, b) = (a.deviation_mm_s, b.deviation_mm_s);
            line("standard deviation", a, b, "mm/s")?;
        }
        let (a, b) = (self.max_deviation_mm, timed.max_deviation_mm);
        line("deviation, most", a, b, "mm")?;
        let (a, b) = (self.rms_deviation_mm, timed.rms_deviation_mm);
        line("deviation, rms", a, b, "mm")?;
        line("bound", self.bound_mm, timed.bound_mm, "mm")?;
        let [a, b] = [&self.motors, &timed.motors].map(FollowedAxes::max_speed_jump_deg_s);
        line("speed jump of a joint", a, b, "deg/s")?;
        let [a, b] = [&self.motors, &timed.motors].map(FollowedAxes::max_acceleration_deg_s2);
        line("acceleration of a joint", a, b, "deg/s²")?;
        let [a, b] = [&self.motors, &timed.motors].map(FollowedAxes::lost_steps);
        writeln!(f, "  {:<28} {a:>8} {b:>8}", "steps lost")?;
        if let Some(torque) = &timed.torque {
            writeln!(f, "torque: {torque}")?;
        }
        if let Some(vibration) = &timed.vibration {
            writeln!(f, "vibration: {vibration}")?;
        }
        Ok(())
    }
}

impl fmt::Display for Report<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{} strokes, {:.0} mm; {:.0} mm of travel above the glass",
            self.strokes, self.length_mm, self.travel_mm
        )?;
        let scale = self.mm_per_unit;
        write!(f, "placed: a unit of the drawing is {scale:.4} mm")?;
        match self.own_mm_per_unit {
            Some(own) => writeln!(f, ", {:.4} times its own size", scale / own)?,
            None => writeln!(f, "; the file states no size in mm")?,
        }
        writeln!(
            f,
            "pattern.bin: {} records ({} fast, {} slow), {} bytes",
            self.records, self.fast_records, self.slow_records, self.bytes
        )?;
        let pulses = &self.pulses;
        writeln!(
            f,
            "simulated from the bytes alone: {} + {} + {} + {} pulses, {:.1} s",
            pulses.elbow, pulses.shoulder, pulses.disc, pulses.vertical, self.duration_s
        )?;
        if let Some([min, max]) = self.tool_speed_mm_s {
            writeln!(
                f,
                "tool: {min:.1} to {max:.1} mm/s along the strokes: the format has one pulse \
                 interval"
            )?;
        }
        writeln!(
            f,
            "disc: turns for {:.1} of the {:.1} s in the glass, and the tool dwells there",
            self.dwell_s, self.in_glass_s
        )?;
        let is_kept = self.max_deviation_mm <= self.bound_mm;
        writeln!(
            f,
            "deviation: {:.3} mm max, {:.3} mm rms; bound {:.3} mm: {}",
            self.max_deviation_mm,
            self.rms_deviation_mm,
            self.bound_mm,
            if is_kept { "kept" } else { "NOT KEPT" }
        )?;
        if self.missing_mm > 0.0 {
            writeln!(f, "not engraved: {:.1} mm of the drawing", self.missing_mm)?;
        }
        writeln!(
            f,
            "motors: at least {:.1} deg/s of jump in a joint of the arm, {} steps lost",
            self.motors.max_speed_jump_deg_s(),
            self.motors.lost_steps()
        )?;
        self.write_comparison(f)
    }
}

impl<'a> MachineReport<'a> {
    fn new(machine: &'a Machine) -> Self {
        let joints = [machine.elbow, machine.shoulder, machine.disc];
        let [elbow, shoulder, disc] = joints.map(|joint| joint.rad_per_pulse);
        let rad_per_pulse = Joints {
            elbow,
            shoulder,
            disc,
        };
        let [elbow, shoulder, disc] = joints.map(|joint| joint.home_rad);
        Self {
            upper_mm: machine.arm.upper(),
            fore_mm: machine.arm.fore(),
            rad_per_pulse,
            home_rad: Joints {
                elbow,
                shoulder,
                disc,
            },
            mm_per_vertical_pulse: machine.settings.mm_per_vertical_pulse(),
            lift_pulses: machine.lift_pulses,
            axis_codes: machine.format.axis_codes.codes(),
            byte_order: machine.format.byte_order,
            direction_bit: "set for negative pulses",
            half_period_ticks: machine.half_period_ticks,
            tick_ns: 1e9 * machine.tick_s(),
            settings: &machine.settings,
        }
    }
}
