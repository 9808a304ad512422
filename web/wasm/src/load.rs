//! What motors are asked for and how a tool swings, where a machine's load is known.

use known_load::{TorqueUsed, Vibration};

use crate::answer::Answer;

/// Rows of seconds and the parts of the motors' torque in percent, with what is planned of them; rows of
/// seconds and µm off its place.
pub(crate) fn add_to(
    answer: Answer,
    torque: Option<&TorqueUsed<3>>,
    vibration: Option<&Vibration>,
) -> Answer {
    const PERCENT: f64 = 100.0;
    const UM_PER_MM: f64 = 1000.0;
    let used = torque.into_iter().flat_map(|used| {
        let planned = PERCENT * used.planned();
        used.over_time().map(move |(t_s, parts)| {
            let [first, second, third] = parts.map(|part| PERCENT * part);
            [t_s, planned, first, second, third]
        })
    });
    let swings = vibration.into_iter().flat_map(Vibration::over_time);
    answer
        .with_rows("torque used", used)
        .with_rows("vibration", swings.map(|[t_s, mm]| [t_s, UM_PER_MM * mm]))
}
