//! Commands and answers as telegrams of 3964R.

use core::fmt::{self, Display, Formatter};
use core::time::Duration;

use embassy_futures::select::{Either, select};
use embedded_io_async::{Read, Write};
use heapless::Deque;
use proto3964r::embedded_io_async::{AsyncClock, Driver};
use proto3964r::{CharacterError, Config, Event, Line, Priority, Station};
use scara_kin::Joints;

use crate::command::{Command, Joint};
use crate::panel::Panel;
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
/// Each command has one answer; `home`, `line` and `jog` have another one at their end.
/// `line_error` says what an error of the port is, none for a BREAK.
pub async fn talk<R, W>(
    machine: &Machine,
    panel: &Panel,
    line: Line,
    (reader, writer): (R, W),
    line_error: impl Fn(R::Error) -> Option<CharacterError>,
) -> !
where
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
            Either::First(Ok(Event::Received(telegram))) => answer(machine, panel, telegram),
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

fn answer(machine: &Machine, panel: &Panel, telegram: &[u8]) -> Option<Text> {
    let command = match Command::parse(telegram) {
        Ok(command) => command,
        Err(error) => return Some(text!("{error}")),
    };
    Some(match command {
        Command::Where => text!("{}", machine.place(panel.steps())),
        Command::Status => panel.status(),
        Command::Limits => text!("{}", Limits(machine)),
        command => return panel.take(command),
    })
}

/// Steps of both joints, to be printed as tool, joints and steps.
pub(crate) struct AtSteps<'m> {
    machine: &'m Machine,
    steps: [i32; 2],
}

impl Machine {
    pub(crate) const fn place(&self, steps: [i32; 2]) -> AtSteps<'_> {
        AtSteps {
            machine: self,
            steps,
        }
    }
}

impl Display for AtSteps<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [shoulder, elbow] = [0, 1].map(|joint| {
            let scale = self.machine.scales[joint];
            scale.to_position(self.steps[joint])
        });
        let tool = self.machine.arm.forward(Joints::new(shoulder, elbow));
        write!(
            f,
            "x {:.3} y {:.3} mm, shoulder {:.3} elbow {:.3} degrees, steps {} {}",
            tool.x,
            tool.y,
            shoulder.to_degrees(),
            elbow.to_degrees(),
            self.steps[0],
            self.steps[1]
        )
    }
}

/// Where a machine can go, and how fast.
struct Limits<'m>(&'m Machine);

impl Display for Limits<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Machine { arm, limits, .. } = self.0;
        write!(f, "reach {:.1} to {:.1} mm", arm.inner_reach(), arm.reach())?;
        for ((joint, range), limits) in Joint::ALL.iter().zip(self.0.ranges()).zip(limits) {
            write!(
                f,
                ", {joint} {:.1} to {:.1} degrees, {:.0} /s, {:.0} /s2",
                range.min().to_degrees(),
                range.max().to_degrees(),
                limits.speed.to_degrees(),
                limits.acceleration.to_degrees()
            )?;
        }
        Ok(())
    }
}
