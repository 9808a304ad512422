//! Every byte-level vector of `tests/data/vectors.txt`, each as a test of its own: characters with
//! their times, and events with their times, must be exactly those.

use core::time::Duration;

use proto3964r::{
    Abandoned, Cause, CharacterError, Config, Event, Failure, JobPhase, Line, Priority, Rejection,
    Station, Transmit, frame::FrameError,
};

const VECTORS: &str = include_str!("../data/vectors.txt");

/// A record of what the station did: `t` in ms, and bytes or an event.
#[derive(Debug, Default, PartialEq, Eq)]
struct Record {
    bytes: Vec<(u64, u8)>,
    events: Vec<(u64, String)>,
}

impl Record {
    /// Reads the fifth column.
    fn expected(text: &str) -> Self {
        let mut record = Self::default();
        for item in text
            .split(';')
            .map(str::trim)
            .filter(|item| !item.is_empty())
        {
            let (time, item) = match item.strip_prefix("t=") {
                Some(timed) => {
                    let (time, item) = timed.split_once(' ').unwrap();
                    (time.parse().unwrap(), item)
                }
                None => (0, item),
            };
            if item.contains('(') {
                record.events.push((time, item.to_owned()));
            } else {
                record
                    .bytes
                    .extend(hex(item).into_iter().map(|byte| (time, byte)));
            }
        }
        record
    }
}

fn hex(text: &str) -> Vec<u8> {
    text.split_whitespace()
        .map(|byte| u8::from_str_radix(byte, 16).unwrap())
        .collect()
}

fn payload(text: &str) -> Vec<u8> {
    if text == "empty" {
        Vec::new()
    } else {
        hex(text)
    }
}

/// A station of the given size in simulated time.
struct Bench<const N: usize> {
    station: Station<N>,
    now_ms: u64,
    /// Events are left in the station: the receive buffer stays in use.
    hold_events: bool,
    record: Record,
}

impl<const N: usize> Bench<N> {
    fn new(configuration: &str) -> Self {
        let priority = if configuration.contains("high") {
            Priority::High
        } else {
            Priority::Low
        };
        let config = if configuration.contains("3964") {
            Config::siemens_3964(priority, Line::Instant)
        } else {
            Config::siemens_3964r(priority, Line::Instant)
        };
        let mut bench = Self {
            station: Station::new(Config {
                nak_at_startup: false,
                ..config
            }),
            now_ms: 0,
            hold_events: false,
            record: Record::default(),
        };
        if configuration.contains("nobuf") {
            bench.hold_events = true;
            bench.receive(&[0x02]);
            bench.receive(&[0x41, 0x10, 0x03, 0x52]);
            bench.record = Record::default();
        }
        bench
    }

    fn now(&self) -> Duration {
        Duration::from_millis(self.now_ms)
    }

    fn receive(&mut self, bytes: &[u8]) {
        let mut rest = bytes;
        while !rest.is_empty() {
            let taken = self.station.handle_bytes(self.now(), rest);
            rest = &rest[taken..];
            self.pull();
        }
    }

    fn pull(&mut self) {
        let mut out = [0; 7]; // smaller than most blocks: they go out in pieces
        while let Some(transmit) = self.station.poll_transmit(self.now(), &mut out) {
            if let Transmit::Bytes(bytes) = transmit {
                self.record
                    .bytes
                    .extend(bytes.iter().map(|&byte| (self.now_ms, byte)));
            }
        }
        while !self.hold_events {
            let Some(event) = self.station.poll_event() else {
                break;
            };
            let Some(name) = name(event) else { continue };
            self.record.events.push((self.now_ms, name));
        }
    }

    fn pass(&mut self, ms: u64) {
        let end = self.now_ms + ms;
        while let Some(due) = self
            .station
            .poll_timeout()
            .filter(|&due| due <= Duration::from_millis(end))
        {
            self.now_ms = self
                .now_ms
                .max(u64::try_from(due.as_nanos().div_ceil(1_000_000)).unwrap());
            self.station.handle_timeout(self.now());
            self.pull();
        }
        self.now_ms = end;
    }

    fn run(&mut self, stimuli: &str) {
        for stimulus in stimuli.split(", ") {
            if let Some(bytes) = stimulus.strip_prefix("rx ") {
                match bytes.split_once(" (byte 1 flagged") {
                    None => self.receive(&hex(bytes)),
                    Some((bytes, _)) => {
                        let bytes = hex(bytes);
                        self.station
                            .handle_damaged(self.now(), bytes[0], CharacterError::Parity);
                        self.receive(&bytes[1..]);
                    }
                }
            } else if let Some(text) = stimulus.strip_prefix("send(") {
                self.station
                    .submit(self.now(), &payload(text.trim_end_matches(')')))
                    .unwrap();
                self.pull();
            } else if let Some(ms) = stimulus.strip_prefix('+') {
                self.pass(ms.trim_end_matches(" ms").parse().unwrap());
            } else {
                assert_eq!(stimulus, "buffer freed");
                assert!(matches!(
                    self.station.poll_event(),
                    Some(Event::Received(b"A"))
                ));
                self.hold_events = false;
                self.pass(0);
            }
        }
        self.hold_events = false;
        if self.record.events.is_empty() {
            self.pull();
        }
    }
}

/// The name that the table has for an event; the collision reports are tested elsewhere.
fn name(event: Event<'_>) -> Option<String> {
    let hex = |bytes: &[u8]| {
        bytes
            .iter()
            .map(|byte| format!("{byte:02X}"))
            .collect::<Vec<_>>()
            .join(" ")
    };
    Some(match event {
        Event::Received([]) => "Received(empty)".to_owned(),
        Event::Received(payload) => format!("Received({})", hex(payload)),
        Event::Sent { len } => format!("Sent({len})"),
        Event::Failed(Failure { phase, cause, .. }) => {
            let phase = match phase {
                JobPhase::Connection => "setup",
                JobPhase::Transmission => "transfer",
            };
            match cause {
                Cause::Timeout => format!("SendFailed({phase}:QVZ)"),
                Cause::Nak => format!("SendFailed({phase}:NAK)"),
                _ => format!("SendFailed({phase}:{cause})"),
            }
        }
        Event::Rejected(rejection) => match rejection {
            Rejection::Frame(FrameError::Bcc { .. }) => "RxError(bcc)",
            Rejection::Frame(FrameError::IllegalDle { .. }) => "RxError(dle)",
            Rejection::Frame(FrameError::TooLong { .. }) => "RxError(overflow)",
            Rejection::Line(_) => "RxError(line)",
            Rejection::CharacterDelay => "RxError(ZVZ)",
            Rejection::NoBuffer => "RxError(nobuf)",
            Rejection::Noise { .. } => "RxError(noise)",
            other => return Some(format!("RxError({other})")),
        }
        .to_owned(),
        Event::Abandoned(Abandoned::NoRepeat) => "ReceiveFailed(BWZ)".to_owned(),
        Event::Conflict { .. } | Event::SamePriority => return None,
        other => format!("{other:?}"),
    })
}

fn check(line: &str) -> Result<(), String> {
    let columns: Vec<_> = line.split('|').map(str::trim).collect();
    let [number, case, configuration, stimuli, expected] = columns[..] else {
        panic!("five columns: {line}");
    };
    let record = if configuration.contains("max=4") {
        let mut bench = Bench::<4>::new(configuration);
        bench.run(stimuli);
        bench.record
    } else {
        let mut bench = Bench::<64>::new(configuration);
        bench.run(stimuli);
        // The table's nobuf cases begin with a telegram that nobody took.
        bench
            .record
            .events
            .retain(|(_, name)| !(configuration.contains("nobuf") && name == "Received(41)"));
        bench.record
    };
    let expected = Record::expected(expected);
    if record == expected {
        return Ok(());
    }
    Err(format!(
        "vector {number}, {case}:\n  expected {expected:02X?}\n  got      {record:02X?}"
    ))
}

fn lines() -> impl Iterator<Item = &'static str> {
    VECTORS.lines().filter(|line| !line.starts_with('#'))
}

/// One test per line of the table, and one that no line is left out.
macro_rules! vectors {
    ($($number:literal $test:ident)*) => {
        $(#[test]
        fn $test() {
            let start = concat!($number, " | ");
            let line = lines().find(|line| line.starts_with(start)).unwrap();
            if let Err(difference) = check(line) {
                panic!("{difference}");
            }
        })*

        #[test]
        fn every_line_has_its_test() {
            let numbers = [$(stringify!($number)),*];
            assert!(lines().map(|line| line.split(' ').next().unwrap()).eq(numbers));
        }
    };
}

vectors! {
    1 v01_rx_one_byte
    2 v02_rx_empty_block
    3 v03_rx_dle_payload
    4 v04_rx_etx_in_payload_is_data
    5 v05_rx_bcc_02h_stx
    6 v06_rx_bcc_15h_nak
    7 v07_rx_bcc_03h_etx
    9 v09_rx_payload_all_control_chars
    10 v10_rx_payload_dle_etx_10_03
    11 v11_rx_three_dle_then_etx
    14 v14_tx_dle_payload
    15 v15_tx_payload_ending_in_dle_buffer_end
    16 v16_tx_bcc_10h_not_doubled
    17 v17_tx_without_bcc_3964
    18 v18_rx_without_bcc_3964
    19 v19_whole_telegram_in_one_read_partner_did_not_wait_for_our_dle
    21 v21_empty_send_job_if_allowed
    22 v22_stray_dle_after_a_finished_send
    23 v23_rx_wrong_bcc_partner_repeats
    24 v24_rx_wrong_bcc_no_repeat_within_bwz
    26 v26_rx_dle_illegal
    27 v27_rx_parity_error_in_data
    28 v28_rx_zvz_in_data
    29 v29_rx_zvz_right_after_dle
    30 v30_rx_zvz_before_bcc
    32 v32_rx_overlong_max_4
    34 v34_rx_no_buffer_freed_in_time
    35 v35_rx_no_buffer
    36 v36_noise_before_stx
    38 v38_nak_in_idle
    39 v39_dle_in_idle
    41 v41_tx_nak_to_stx_then_dle
    43 v43_tx_garbage_to_stx
    44 v44_tx_qvz_x6_no_answer_at_all
    45 v45_tx_qvz_at_the_end_x6
    46 v46_tx_nak_to_the_block_x6
    49 v49_tx_3964_qvz_is_550_ms
    50 v50_collision_we_are_low
    51 v51_collision_we_are_high
    53 v53_both_high
    56 v56_euchner_hbls_led_7_on
    57 v57_euchner_hbls_text_euchner
    58 v58_euchner_hbls_status_request_and_reply
    59 v59_rk512_send_db5_dw10_2_words
}
