//! Both sides on a simulated line: nothing is lost, whatever it damages.

use core::time::Duration;

use machine_sim::serial_line::{Noise, SerialLine};
use plc::{DamagingLine, MAX_TELEGRAM, Report, Role, Side, Spacing, Traffic};
use proto3964r::{Line, Station, Transmit};

const BITS_PER_SECOND: u32 = 115_200;
/// 8 data bits, even parity, one stop bit.
const BITS_PER_CHARACTER: u8 = 11;
/// Of `Spacing`: no block is hit twice.
const MIN_SPACING: u64 = 280;
/// Ten times what the longest of these runs takes: reaching it means that something is stuck.
const MAX_DURATION: Duration = Duration::from_secs(1000);
/// What waits to be polled is polled so much later.
const SOON: Duration = Duration::from_micros(1);

struct End {
    side: Side,
    station: Station<MAX_TELEGRAM>,
    out: SerialLine,
}

impl End {
    fn new(role: Role, rounds: u8, noise: Noise) -> Self {
        let line = Line::paced(BITS_PER_SECOND, BITS_PER_CHARACTER);
        Self {
            side: Side::new(role, rounds).unwrap(),
            station: Station::new(role.line_config(line)),
            out: SerialLine::new(BITS_PER_SECOND, BITS_PER_CHARACTER, noise),
        }
    }

    fn step(&mut self, now: Duration, incoming: &mut SerialLine) {
        for byte in incoming.receive(now) {
            self.station.handle_byte(now, byte);
            while let Some(event) = self.station.poll_event() {
                self.side.handle(now, Some(event)).unwrap();
            }
        }
        self.station.handle_timeout(now);
        while let Some(event) = self.station.poll_event() {
            self.side.handle(now, Some(event)).unwrap();
        }
        self.side.handle(now, None).unwrap();
        if self.side.wants_recall() {
            self.station.cancel(now);
        }
        if !self.station.is_busy()
            && let Some(telegram) = self.side.poll_transmit(now)
        {
            self.station.submit(now, &telegram).unwrap();
        }
        let mut bytes = [0; 64];
        while let Some(transmit) = self.station.poll_transmit(now, &mut bytes) {
            match transmit {
                Transmit::Discard => self.out.discard(now),
                Transmit::Bytes(bytes) => self.out.send(now, bytes),
            }
        }
    }

    fn next(&self) -> impl Iterator<Item = Duration> {
        let all = [
            self.out.poll_timeout(),
            self.station.poll_timeout(),
            self.side.poll_timeout(),
        ];
        all.into_iter().flatten()
    }
}

fn run(rounds: u8, seed: u64, spacing: u64) -> (Report, Traffic) {
    let mut pc = End::new(Role::Pc, rounds, Noise::new(seed, spacing));
    let mut plc = End::new(Role::Plc, rounds, Noise::new(!seed, spacing));
    let mut now = Duration::ZERO;
    while !(pc.side.is_done() && plc.side.is_done()) {
        assert!(now < MAX_DURATION, "stuck: seed {seed}");
        pc.step(now, &mut plc.out);
        plc.step(now, &mut pc.out);
        now = pc.next().chain(plc.next()).min().unwrap().max(now + SOON);
    }
    let lines = [pc.out.noise(), plc.out.noise()];
    let traffic = Traffic {
        duration: now,
        bytes: lines.iter().map(|line| line.bytes()).sum(),
        damaged: lines.iter().map(|line| line.damaged()).sum(),
    };
    (Report::new(traffic, &pc.side, &plc.side), traffic)
}

#[test]
fn nothing_is_lost_on_a_damaging_line() {
    for seed in 0..8 {
        let (report, traffic) = run(Side::MAX_ROUNDS, seed, MIN_SPACING);
        assert!(traffic.damaged > 100, "{report}");
        report.check().unwrap();
    }
}

#[test]
fn a_clean_line_costs_no_job() {
    let (report, traffic) = run(Side::MAX_ROUNDS, 1, 0);
    report.check().unwrap();
    assert_eq!(traffic.damaged, 0);
    let text = report.to_string();
    for side in ["pc", "plc"] {
        let done = format!("{side}: 60 data blocks written and read back");
        assert!(text.contains(&done), "{text}");
    }
    assert_eq!(
        text.matches(" 0 jobs repeated, 0 blocks rejected").count(),
        2,
        "{text}"
    );
}

/// A check that would let everything pass would be none.
#[test]
fn work_that_is_not_done_is_data_lost() {
    let pc = Side::new(Role::Pc, 1).unwrap();
    let plc = Side::new(Role::Plc, 1).unwrap();
    let report = Report::new(Traffic::default(), &pc, &plc);
    assert_eq!(report.check().unwrap_err().to_string(), "data were lost");
}

#[test]
fn too_many_rounds_do_not_fit() {
    let error = Side::new(Role::Pc, 61).unwrap_err();
    assert_eq!(error.to_string(), "61 rounds: at most 60");
}

#[test]
fn a_block_is_hit_once_at_most() {
    assert_eq!(Spacing::MIN.to_string(), MIN_SPACING.to_string());
    for text in ["0", "280", "300"] {
        assert_eq!(text.parse::<Spacing>().unwrap().to_string(), text);
    }
    for text in ["1", "279"] {
        let error = text.parse::<Spacing>().unwrap_err().to_string();
        let wanted = "must be 0 or at least 280, so that no block is hit twice";
        assert_eq!(error, wanted);
    }
}

#[test]
fn the_log_has_what_arrived() {
    let mut log = Vec::new();
    let mut line = DamagingLine::new(&mut log, Spacing::MIN, 1);
    let now = Duration::from_millis(1500);
    let sent = [0x10; 1000];
    let to_plc = line.pass(now, Role::Pc, &sent).unwrap();
    let to_pc = line.pass(now, Role::Plc, &[0x02]).unwrap();
    let traffic = line.finish(2 * now).unwrap();
    assert_ne!(to_plc, sent);
    assert!((1..=3).contains(&traffic.damaged), "{}", traffic.damaged);
    assert_eq!((traffic.duration, traffic.bytes), (2 * now, 1001));
    let text =
        |bytes: Vec<u8>| -> String { bytes.iter().map(|byte| format!(" {byte:02X}")).collect() };
    let wanted = format!("1.500000 >{}\n1.500000 <{}\n", text(to_plc), text(to_pc));
    assert_eq!(String::from_utf8(log).unwrap(), wanted);
}
