//! What a monitor hears of a clean line.

use core::time::Duration;

use line_sim::{BLOCK, Frame, Simulation, StationSettings};
use machine_sim::Random;
use monitor3964r::{Monitor, Observation, Side, Verdict, diagnose};
use proto3964r::{Config, Line, Priority};

const TELEGRAMS: usize = 40;

/// Telegrams full of control characters.
fn telegrams(random: &mut Random) -> Vec<Vec<u8>> {
    let mut telegram = || {
        let len = 1 + random.next_u64() % 24;
        let bytes = (0..len).map(|_| match random.next_u64() % 8 {
            0 | 1 => 0x10,
            2 => 0x03,
            3 => 0x02,
            4 => 0x15,
            _ => random.next_u64().to_be_bytes()[0],
        });
        bytes.collect()
    };
    (0..TELEGRAMS).map(|_| telegram()).collect()
}

/// Each telegram once, whoever sends when: the start-up NAK of one crosses the first STX of the
/// other.
#[test]
fn every_telegram_once() {
    let config = |priority| Config::siemens_3964r(priority, Line::paced(9600, 11));
    let settings = [Priority::High, Priority::Low].map(|priority| StationSettings {
        config: config(priority),
        frame: Frame::USUAL,
    });
    for seed in 0..5 {
        let mut random = Random::new(seed);
        let jobs = [telegrams(&mut random), telegrams(&mut random)];
        let mut line = Simulation::new(settings, seed);
        for (side, jobs) in [Side::A, Side::B].into_iter().zip(&jobs) {
            for job in jobs {
                line.submit(side, job).unwrap();
            }
        }
        line.run_until(Duration::from_secs(120));
        let mut monitor = Monitor::<BLOCK>::new(config(Priority::Low));
        let mut overheard = [Vec::new(), Vec::new()];
        for heard in line.heard() {
            for step in monitor.handle_byte(heard.at, heard.side, heard.byte) {
                if let Observation::Block { by, payload } = step {
                    overheard[usize::from(by == Side::B)].push(payload.to_vec());
                }
            }
        }
        assert_eq!(overheard, jobs, "seed {seed}");
        let found = diagnose(line.heard(), &config(Priority::Low));
        assert_eq!(found.verdict, Verdict::Works, "seed {seed}");
        assert_eq!((found.a.telegrams, found.b.telegrams), (40, 40));
    }
}
