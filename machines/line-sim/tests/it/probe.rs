//! `probe` at random partners: what it says is right, or nothing.
//!
//! `PARTNERS` from `SEED` on; without them the same few each time:
//! `PARTNERS=1000 cargo test --release -p line-sim --test it probe:: -- --nocapture`.

use core::{
    future::Future,
    pin::pin,
    task::{Context, Poll, Waker},
    time::Duration,
};
use std::env;

use line_sim::{Bench, Faults, Frame, Parity, StationSettings};
use line3964r::probe::{self, Findings, Heard, Options, ParityFound, Span, probe};
use machine_sim::Random;
use proto3964r::{Config, Conflict, IdleNoise, Line, Priority};

use crate::verdicts::case::{between, pick};

const RATES: [u32; 6] = [9600, 19_200, 38_400, 4800, 2400, 1200];

/// A measured time is off by less: two bits at the slowest rate, and a step of the simulation.
const TOLERANCE: Duration = Duration::from_millis(2);

/// A port of the simulated line.
struct Port(Bench);

impl probe::Bench for Port {
    type Error = core::convert::Infallible;

    fn now(&self) -> Duration {
        self.0.now()
    }

    fn tells_damage(&self) -> bool {
        true
    }

    async fn set_frame(&mut self, frame: line3964r::Frame) -> Result<(), Self::Error> {
        let parity = match frame.parity {
            line3964r::Parity::None => Parity::None,
            line3964r::Parity::Even => Parity::Even,
            line3964r::Parity::Odd => Parity::Odd,
        };
        self.0.set_frame(Frame::new(frame.baud, parity).unwrap());
        Ok(())
    }

    async fn send(&mut self, byte: u8) -> Result<(), Self::Error> {
        self.0.send(byte);
        Ok(())
    }

    async fn hear(&mut self, until: Duration) -> Result<Option<Heard>, Self::Error> {
        let heard = self.0.hear(until);
        Ok(heard.map(|(byte, error)| Heard {
            at: self.0.now(),
            byte: error.is_none().then_some(byte),
        }))
    }
}

/// Of a future that never waits.
fn ready<T>(future: impl Future<Output = T>) -> T {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(done) => done,
        Poll::Pending => panic!("it waits"),
    }
}

/// What a partner is, which the probe does not see.
#[derive(Debug)]
struct Partner {
    baud: u32,
    parity: Parity,
    config: Config,
    faults: Faults,
    jobs: Vec<(u64, Vec<u8>)>,
    receives: bool,
}

impl Partner {
    fn new(seed: u64) -> Self {
        let random = &mut Random::new(seed);
        let baud = *pick(random, &RATES);
        let parity = *pick(random, &[Parity::Even, Parity::Odd, Parity::None]);
        let frame = Frame::new(baud, parity).unwrap();
        let line = Line::paced(baud, frame.bits());
        let priority = *pick(random, &[Priority::Low, Priority::High]);
        let preset = *pick(
            random,
            &[Config::siemens_3964r, Config::siemens_3964, Config::linux],
        );
        let config = preset(priority, line);
        let config = Config {
            qvz_ms: *pick(random, &[config.qvz_ms, 1000, 1500]),
            zvz_ms: *pick(random, &[config.zvz_ms, 100, 500]),
            idle_noise: *pick(
                random,
                &[config.idle_noise, IdleNoise::NakAtOnce, IdleNoise::Ignore],
            ),
            conflict: *pick(
                random,
                &[config.conflict, Conflict::YieldOnRetry, Conflict::Repeat],
            ),
            nak_at_startup: random.happens(0.5),
            ..config
        };
        let delay = if random.happens(0.3) {
            between(random, 1, 400)
        } else {
            0
        };
        let faults = Faults {
            is_dead: random.happens(0.05),
            is_deaf: random.happens(0.05),
            keeps_telegrams: random.happens(0.1),
            delay: Duration::from_millis(delay),
            bit_error_rate: if random.happens(0.2) { 1e-4 } else { 0.0 },
            ..Faults::NONE
        };
        let mut jobs = Vec::new();
        let mut at = between(random, 0, 60_000);
        let gap = *pick(random, &[500, 5000, 20_000]);
        while random.happens(0.97) && jobs.len() < 30 {
            let len = between(random, 1, 40);
            jobs.push((
                at,
                (0..len)
                    .map(|_| random.next_u64().to_be_bytes()[0])
                    .collect(),
            ));
            at += between(random, gap, 2 * gap);
        }
        if random.happens(0.4) {
            jobs.clear();
        }
        Self {
            baud,
            parity,
            config,
            faults,
            jobs,
            receives: random.happens(0.5),
        }
    }

    fn probed(&self, seed: u64) -> Findings {
        let settings = StationSettings {
            config: self.config,
            frame: Frame::new(self.baud, self.parity).unwrap(),
        };
        let mut bench = Bench::new(settings, seed);
        bench.set_faults(self.faults);
        for (at, job) in &self.jobs {
            bench.plan(Duration::from_millis(*at), job).unwrap();
        }
        let options = Options {
            rates: RATES.to_vec(),
            receives: self.receives,
            listen: Duration::from_secs(60),
        };
        match ready(probe(&mut Port(bench), &options)) {
            Ok(found) => found,
        }
    }

    /// What of the findings is wrong.
    fn errors(&self, found: &Findings) -> Vec<String> {
        let mut errors = Vec::new();
        let mut check = |is_right: bool, what: String| {
            if !is_right {
                errors.push(what);
            }
        };
        if let Some((baud, parity)) = found.frame {
            let fits = match parity {
                ParityFound::EvenOrNone => self.parity != Parity::Odd,
                ParityFound::Even => self.parity == Parity::Even,
                ParityFound::Odd => self.parity == Parity::Odd,
                ParityFound::None => self.parity == Parity::None,
            };
            check(baud == self.baud && fits, format!("{baud} bit/s, {parity}"));
        }
        let near = |span: Span, time: Duration| {
            let off = |measured: Duration| measured.abs_diff(time) <= TOLERANCE;
            off(span.from) && off(span.to)
        };
        let ms = |ms: u16| Duration::from_millis(ms.into());
        for (name, span, time) in [
            ("answer", found.answer, self.faults.delay),
            ("ZVZ", found.zvz, ms(self.config.zvz_ms)),
            ("QVZ", found.qvz, ms(self.config.qvz_ms)),
        ] {
            if let Some(span) = span {
                check(near(span, time), format!("{name} {span}"));
            }
        }
        if let Some(priority) = found.priority {
            check(priority == self.config.priority, format!("{priority:?}"));
        }
        if let Some(bcc) = found.check {
            check(bcc == self.config.check, format!("{bcc:?}"));
        }
        if let Some(longest) = found.longest {
            let is_one = self.jobs.iter().any(|(_, job)| job.len() == longest);
            check(is_one, format!("a block of {longest}"));
        }
        errors
    }

    /// Whether nothing keeps it from answering.
    const fn answers(&self) -> bool {
        !self.faults.is_dead && !self.faults.is_deaf
    }
}

#[test]
fn what_is_said_of_a_partner_is_right() {
    let number =
        |name: &str, usual: u64| env::var(name).map_or(usual, |text| text.parse().unwrap());
    let (first, partners) = (number("SEED", 1), number("PARTNERS", 60));
    let (mut wrong, mut told, mut answering) = (Vec::new(), [0; 5], 0);
    for case in 0..partners {
        let seed = (first + case).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let partner = Partner::new(seed);
        let found = partner.probed(seed);
        let errors = partner.errors(&found);
        if !errors.is_empty() {
            wrong.push(format!("seed {seed}: {errors:?} of {partner:?}: {found:?}"));
        }
        answering += u64::from(partner.answers());
        for (count, is_told) in told.iter_mut().zip([
            found.frame.is_some(),
            found.answer.is_some(),
            found.priority.is_some(),
            found.qvz.is_some(),
            found.check.is_some(),
        ]) {
            *count += u64::from(is_told);
        }
    }
    println!(
        "{partners} partners, {answering} that answer: rate {}, times {}, priority {}, QVZ {}, BCC {}; wrong {}",
        told[0],
        told[1],
        told[2],
        told[3],
        told[4],
        wrong.len()
    );
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
    // Noise, and jobs of its own all the time, may hide it.
    assert!(told[0] * 100 >= answering * 90, "{told:?} of {answering}");
}
