//! Charts of torque and vibration over time.

use machine_sim::{Axis, Plot, Stroke};

use crate::torque::TorqueUsed;
use crate::vibration::Vibration;

/// What each motor is asked for, by the names of the axes.
#[must_use]
pub fn torque_chart<const N: usize>(used: &TorqueUsed<N>, axes: [&str; N], time: Axis) -> Plot {
    const PERCENT: f64 = 100.0;
    let torque = Axis::new("torque in % of pull-out").including(0.0);
    let mut plot = Plot::chart(time, torque).with_title("Torque of the motors");
    for (axis, name) in axes.into_iter().enumerate() {
        let parts = used.over_time().map(|(t_s, parts)| {
            let part = parts.get(axis).copied().unwrap_or_default();
            [t_s, PERCENT * part]
        });
        plot = plot.line(name, Stroke::series(axis), parts);
    }
    let last_s = used.over_time().last().map_or(0.0, |(t_s, _)| t_s);
    let planned = PERCENT * used.planned();
    plot.line(
        "planned at most",
        Stroke::LIMIT,
        [[0.0, planned], [last_s, planned]],
    )
}

/// How far a tool by its name is off its place, with and without shaping.
#[must_use]
pub fn vibration_chart(tool: &str, vibration: &Vibration, unshaped: Option<&Vibration>) -> Plot {
    const UM_PER_MM: f64 = 1000.0;
    let um = |vibration: &Vibration| {
        let points = vibration.over_time();
        points
            .map(|[t_s, mm]| [t_s, UM_PER_MM * mm])
            .collect::<Vec<_>>()
    };
    let axis = Axis::new("off its place in µm").including(0.0);
    let mut plot =
        Plot::chart(Axis::new("time in s"), axis).with_title(format!("Vibration of {tool}"));
    if let Some(plain) = unshaped {
        plot = plot.line("without shaping", Stroke::OTHER, um(plain));
    }
    plot.line("driven by the steps", Stroke::ACTUAL, um(vibration))
}
