//! Commands and answers as telegrams of 3964R.

use core::fmt::{self, Display, Formatter};
use core::time::Duration;

use embassy_futures::select::{Either, select};
use embedded_io_async::{Read, Write};
use heapless::Deque;
use proto3964r::embedded_io_async::{AsyncClock, Driver};
use proto3964r::{CharacterError, Config, Event, Line, Priority, Station};

use crate::command::Command;
use crate::inputs::Inputs;
use crate::kinematics::Kinematics;
use crate::panel::{Panel, State};
use crate::scales::Reading;
use crate::settings::Machine;
use crate::{MAX_ANSWER, Text, text};

/// Longest telegram that is taken, in bytes.
const MAX_COMMAND: usize = 64;
/// Answers that wait for the line.
const ANSWERS: usize = 8;

/// The clock of `embassy-time`.
struct Clock;

impl AsyncClock for Clock {
    fn now(&mut self) -> Duration {
        Duration::from_micros(embassy_time::Instant::now().as_micros())
    }

    async fn sleep_until(&mut self, time: Duration) {
        let micros = u64::try_from(time.as_micros()).unwrap_or(u64::MAX);
        embassy_time::Timer::at(embassy_time::Instant::from_micros(micros)).await;
    }
}

/// Takes commands from a line and gives answers: the station of low priority.
///
/// Each command has one answer; those that move have another one at their end.
/// `line_error` says what an error of the port is, none for a BREAK.
pub async fn talk<K, const N: usize, R, W>(
    machine: &Machine<K, N>,
    panel: &Panel<N>,
    inputs: &impl Inputs<N>,
    line: Line,
    (reader, writer): (R, W),
    line_error: impl Fn(R::Error) -> Option<CharacterError>,
) -> !
where
    K: Kinematics<N>,
    R: Read,
    W: Write<Error = R::Error>,
{
    let config = Config::siemens_3964r(Priority::Low, line);
    let station = Station::<MAX_COMMAND, MAX_ANSWER>::with_buffers(config);
    let mut driver = Driver::new(station, reader, writer, Clock);
    let mut answers = Deque::<Text, ANSWERS>::new();
    loop {
        if !driver.is_busy()
            && let Some(answer) = answers.pop_front()
        {
            // It is neither busy nor is the answer too long.
            let _ = driver.submit(answer.as_bytes());
        }
        let answer = match select(driver.wait(), panel.next_answer()).await {
            Either::First(Ok(Event::Received(telegram))) => {
                answer(machine, panel, inputs, telegram)
            }
            // One that could not be sent is given up: the partner is not there.
            Either::First(Ok(_)) => None,
            Either::First(Err(error)) => {
                let (station, now) = (driver.station_mut(), Clock.now());
                match line_error(error) {
                    // Which character it was, the port does not say.
                    Some(error) => station.handle_damaged(now, 0, error),
                    None => station.handle_break(now),
                }
                None
            }
            Either::Second(answer) => Some(answer),
        };
        if let Some(answer) = answer {
            // A partner that sends commands and takes no answers loses the latest.
            let _ = answers.push_back(answer);
        }
    }
}

fn answer<K: Kinematics<N>, const N: usize>(
    machine: &Machine<K, N>,
    panel: &Panel<N>,
    inputs: &impl Inputs<N>,
    telegram: &[u8],
) -> Option<Text> {
    let command = match Command::parse::<K>(telegram) {
        Ok(command) => command,
        Err(error) => return Some(text!("{error}")),
    };
    Some(match command {
        Command::Where => text!("{}", machine.place(panel.steps())),
        Command::Status => panel.status(),
        Command::Limits => text!("{}", Limits(machine)),
        Command::Machine => text!("{}", K::NAME),
        Command::Scales => match inputs.counts() {
            Some(counts) if machine.has_scales() => {
                let is_homed = !matches!(panel.state(), State::NotHomed | State::Homing);
                let reading = panel.read_scales(counts);
                text!(
                    "{}",
                    ScalesAt {
                        machine,
                        reading,
                        is_homed
                    }
                )
            }
            _ => text!("refused: no scales"),
        },
        command => return panel.take(command),
    })
}

/// Steps of all axes, to be printed as tool, axes and steps.
pub(crate) struct AtSteps<'m, K, const N: usize> {
    machine: &'m Machine<K, N>,
    steps: [i32; N],
}

impl<K, const N: usize> Machine<K, N> {
    pub(crate) const fn place(&self, steps: [i32; N]) -> AtSteps<'_, K, N> {
        AtSteps {
            machine: self,
            steps,
        }
    }
}

impl<K: Kinematics<N>, const N: usize> Display for AtSteps<'_, K, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut axes = [0.0; N];
        let scales = self.machine.scales.iter().zip(self.steps);
        for (axis, (scale, steps)) in axes.iter_mut().zip(scales) {
            *axis = scale.to_position(steps);
        }
        match self.machine.kinematics.tool_mm(axes) {
            Ok(tool) => {
                for (name, at) in COORDINATES.into_iter().zip(tool) {
                    write!(f, "{name} {:.3} ", plain(at))?;
                }
                write!(f, "mm,")?;
            }
            Err(reason) => write!(f, "nowhere: {reason},")?,
        }
        if !K::IS_CARTESIAN {
            let unit = Machine::<K, N>::UNIT;
            for (name, axis) in K::AXES.into_iter().zip(axes) {
                write!(f, " {name} {:.3}", plain(unit.shown(axis)))?;
            }
            write!(f, " {},", unit.name())?;
        }
        write!(f, " steps")?;
        for steps in self.steps {
            write!(f, " {steps}")?;
        }
        Ok(())
    }
}

/// Without the sign of what is shown as zero.
fn plain(value: f64) -> f64 {
    if value.abs() < 0.0005 { 0.0 } else { value }
}

/// Names of the tool's coordinates.
const COORDINATES: [&str; 3] = ["x", "y", "z"];

/// Where a machine can go, and how fast.
struct Limits<'m, K, const N: usize>(&'m Machine<K, N>);

impl<K: Kinematics<N>, const N: usize> Display for Limits<'_, K, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Machine {
            kinematics,
            ranges,
            limits,
            ..
        } = self.0;
        let unit = Machine::<K, N>::UNIT;
        kinematics.fmt_reach(f)?;
        let axes = K::AXES.into_iter().zip(ranges).zip(limits);
        for (index, ((name, range), limits)) in axes.enumerate() {
            let [min, max] = range.map(|end| unit.shown(end));
            let comma = if index > 0 { ", " } else { "" };
            write!(
                f,
                "{comma}{name} {min:.1} to {max:.1} {}, {:.0} /s, {:.0} /s2",
                unit.name(),
                unit.shown(limits.speed),
                unit.shown(limits.acceleration)
            )?;
        }
        Ok(())
    }
}

/// What the scales of a machine say, to be printed: places once it is homed, counts, and what has been
/// corrected.
struct ScalesAt<'m, K, const N: usize> {
    machine: &'m Machine<K, N>,
    reading: Reading<N>,
    is_homed: bool,
}

impl<K: Kinematics<N>, const N: usize> Display for ScalesAt<'_, K, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self {
            machine, reading, ..
        } = self;
        let axes = || {
            let axes = machine.loops.iter().enumerate();
            axes.filter_map(|(axis, scale)| Some((axis, scale.as_ref()?)))
        };
        if self.is_homed {
            let unit = Machine::<K, N>::UNIT;
            for (axis, scale) in axes() {
                let steps = scale.steps(reading.counts[axis], reading.home_steps[axis]);
                let at = unit.shown(steps / machine.scales[axis].steps_per_unit());
                write!(f, "{} {:.3} ", K::AXES[axis], plain(at))?;
            }
            write!(f, "{}, ", unit.name())?;
        }
        write!(f, "counts")?;
        for (axis, _) in axes() {
            write!(f, " {}", reading.counts[axis])?;
        }
        if self.is_homed {
            write!(f, ", corrected")?;
            for (axis, _) in axes() {
                write!(f, " {}", reading.corrected_steps[axis])?;
            }
            write!(f, " steps")?;
        }
        Ok(())
    }
}
