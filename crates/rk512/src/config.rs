//! Times of client and server.

use core::time::Duration;

/// Times of a client or server.
///
/// Begin with the defaults, change what differs:
/// ```
/// use core::time::Duration;
/// use rk512::Config;
///
/// const CONFIG: Config = Config {
///     reaction_time: Config::reaction_time_for(9600),
///     ..Config::DEFAULT
/// };
/// assert_eq!(CONFIG.reaction_time, Duration::from_secs(5));
/// ```
/// RK512 numbers nothing: a reaction that comes twice or too late looks like the one that is due
/// now. Two times keep them apart: [`quiet`](Self::quiet) and [`resync`](Self::resync).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[expect(
    clippy::exhaustive_structs,
    reason = "plain settings, to be written as a literal on top of the defaults"
)]
pub struct Config {
    /// Client: from the delivery of a command to its reaction, at most. Siemens: 20 s, or
    /// [by baud rate](Self::reaction_time_for). WAGO's default is 500 ms.
    pub reaction_time: Duration,
    /// Client: pause after each reaction before the next telegram; reactions that come in it are
    /// repeats and are dropped. 0 by default: Siemens knows no such pause.
    ///
    /// For transports that repeat a telegram whose acknowledgement was lost (3964R does) to a
    /// partner that does not [take it back](crate::Endpoint::wants_recall); then longer than such
    /// a repeat takes. On 3964R that is three times the acknowledgement delay time (QVZ).
    pub quiet: Duration,
    /// Client: pause after a job that ended without its reaction; a late reaction that comes in it
    /// is dropped. A refusal is a reaction. 2 s by default, as long as a 3964R partner waits for an
    /// answer.
    pub resync: Duration,
    /// Server: from the delivery of a reaction to the continuation, at most; then the job is given
    /// up. 20 s by default, as the client's time.
    pub continuation_time: Duration,
}

impl Config {
    /// The defaults.
    pub const DEFAULT: Self = Self {
        reaction_time: Duration::from_secs(20),
        quiet: Duration::ZERO,
        resync: Duration::from_secs(2),
        continuation_time: Duration::from_secs(20),
    };

    /// Reaction monitoring time by baud rate, in bit/s.
    ///
    /// | bit/s | from 300 | from 600 | from 1200 | from 38400 |
    /// |---|---|---|---|---|
    /// | time | 10 s | 7 s | 5 s | 3 s |
    ///
    /// 20 s below 300 bit/s. Source: Siemens help for S7-300/400 point-to-point, which names 300,
    /// 600, 1200 and 38400 bit/s; a rate between two of these has the longer time here.
    #[must_use]
    pub const fn reaction_time_for(baud: u32) -> Duration {
        Duration::from_secs(match baud {
            ..300 => 20,
            300..600 => 10,
            600..1200 => 7,
            1200..38_400 => 5,
            38_400.. => 3,
        })
    }
}

impl Default for Config {
    fn default() -> Self {
        Self::DEFAULT
    }
}
