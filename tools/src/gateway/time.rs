//! Times of files, and the time of day.

use core::time::Duration;

use jiff::Timestamp;

/// The longest time: 30 years, which every clock bears.
const MAX_S: f64 = 1e9;

/// A time of a file.
pub(crate) fn duration(seconds: f64) -> Result<Duration, String> {
    match Duration::try_from_secs_f64(seconds) {
        Ok(time) if !time.is_zero() && seconds <= MAX_S => Ok(time),
        _ => Err(format!("{seconds} is no time in seconds, up to {MAX_S}")),
    }
}

/// The time of day, in UTC to the millisecond.
pub(crate) fn now() -> String {
    format!("{:.3}", Timestamp::now())
}
