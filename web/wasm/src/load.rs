//! What motors are asked for and how tools swing, where a machine's load is known.

use known_load::{TorqueUsed, Vibration};

use crate::answer::Answer;

/// Rows of seconds and of what is planned of the motors' torque in percent, with what is asked of
/// each; `torque used`.
pub(crate) fn with_torque<const N: usize>(
    answer: Answer,
    torque: Option<&TorqueUsed<N>>,
) -> Answer {
    const PERCENT: f64 = 100.0;
    let mut numbers = Vec::new();
    if let Some(used) = torque {
        for (t_s, parts) in used.over_time() {
            numbers.extend([t_s, PERCENT * used.planned()]);
            numbers.extend(parts.map(|part| PERCENT * part));
        }
    }
    answer.with_numbers("torque used", numbers.into_iter().map(f64::to_le_bytes))
}

/// Rows of seconds and µm off its place; `vibration`, or another name.
pub(crate) fn with_vibration(
    answer: Answer,
    name: &'static str,
    vibration: Option<&Vibration>,
) -> Answer {
    const UM_PER_MM: f64 = 1000.0;
    let swings = vibration.into_iter().flat_map(Vibration::over_time);
    answer.with_rows(name, swings.map(|[t_s, mm]| [t_s, UM_PER_MM * mm]))
}
