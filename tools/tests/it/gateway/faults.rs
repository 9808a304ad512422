//! The faults of `line-sim` that a partner can have, each through a running gateway.
//!
//! `cargo test -p line3964r --test it gateway::faults -- --ignored --nocapture`

use alloc::{collections::BTreeMap, sync::Arc};
use core::time::Duration;
use std::sync::Mutex;

use line_sim::{Bench, Faults, Frame, Parity, StationSettings};
use monitor3964r::{Character, Side, diagnose};
use proto3964r::{Config, Line, Priority};
use rumqttc::v5::mqttbytes::QoS;
use serde_json::{Value, json};
use tokio::{
    io::{AsyncReadExt as _, AsyncWriteExt as _},
    net::TcpListener,
    time::{Instant, MissedTickBehavior, interval},
};

use super::{
    broker_or_skip,
    listeners::listen,
    process::{Gateway, mqtt},
    subscriber::Subscriber,
};

/// How long each line is at work.
const SECONDS: u64 = 75;
/// When the side that dies does so.
const DEATH: Duration = Duration::from_secs(25);
/// From one telegram of a side to the next.
const GATEWAY_SENDS: Duration = Duration::from_millis(1500);
const PARTNER_SENDS_MS: u64 = 1300;

/// A line, and the verdicts that are right.
struct Kind {
    name: &'static str,
    frame: Frame,
    config: fn(Priority, Line) -> Config,
    /// The partner's; the gateway's is low.
    priority: Priority,
    faults: Faults,
    dies: bool,
    /// Whether the gateway sends, and the partner.
    sends: [bool; 2],
    qvz_ms: u16,
    /// The gateway's.
    preset: &'static str,
    /// What becomes of the characters between the two.
    wire: Wire,
    /// What the partner sends.
    telegram: fn(u8) -> Vec<u8>,
    right: Vec<Value>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Wire {
    Whole,
    /// Nothing reaches the gateway.
    Open,
    /// The gateway hears what it sends.
    Shared,
}

impl Kind {
    fn new(name: &'static str, faults: Faults, sends: [bool; 2], right: Vec<Value>) -> Self {
        Self {
            name,
            frame: Frame::USUAL,
            config: Config::siemens_3964r,
            priority: Priority::High,
            faults,
            dies: false,
            sends,
            qvz_ms: 2000,
            preset: "siemens-3964r",
            wire: Wire::Whole,
            telegram: |number| vec![0x57, number, 0x10, 0x33, 0x41],
            right,
        }
    }

    /// Whether a verdict is one of those, about the right side.
    fn is_right(&self, found: &Value) -> bool {
        self.right.iter().any(|right| match right.as_object() {
            None => {
                found == right
                    || right == &json!("Repeats") && found.get("WorksWithRepeats").is_some()
            }
            Some(right) => right.iter().all(|(name, fields)| {
                let fields = fields.as_object().unwrap();
                found.get(name).is_some()
                    && fields
                        .iter()
                        .all(|(field, value)| found[name][field] == *value)
            }),
        })
    }

    fn line(&self, port: u16) -> String {
        let (name, qvz_ms, preset) = (self.name, self.qvz_ms, self.preset);
        format!(
            "[[line]]\nname = \"{name}\"\nport = \"tcp://127.0.0.1:{port}?baud=9600\"\npriority = \"low\"\npreset = \"{preset}\"\nqvz_ms = {qvz_ms}\n"
        )
    }

    /// What `line3964r monitor` is told of the line: the preset of both.
    fn expected(&self) -> Config {
        let preset = match self.preset {
            "siemens-3964" => Config::siemens_3964,
            _ => Config::siemens_3964r,
        };
        preset(Priority::Low, Line::paced(9600, self.frame.bits()))
    }

    fn bench(&self, seed: u64) -> Bench {
        let config = (self.config)(self.priority, Line::paced(9600, self.frame.bits()));
        let frame = self.frame;
        let mut bench = Bench::new(StationSettings { config, frame }, seed);
        bench.set_faults(self.faults);
        if self.sends[1] {
            for number in 0..SECONDS * 1000 / PARTNER_SENDS_MS {
                let at = Duration::from_millis(400 + number * PARTNER_SENDS_MS);
                let [.., byte] = number.to_be_bytes();
                bench.plan(at, &(self.telegram)(byte)).unwrap();
            }
        }
        bench
    }
}

fn frame(baud: u32, parity: Parity) -> Frame {
    Frame::new(baud, parity).unwrap()
}

fn kinds() -> Vec<Kind> {
    let none = Faults::NONE;
    let (both, gateway, partner) = ([true; 2], [true, false], [false, true]);
    let of_b = |name: &str, field: &str| json!({ name: { field: "B" } });
    let works = || vec![json!("Works"), json!("Repeats")];
    let bad = || json!({ "BadBlocks": { "sender": "B" } });
    let noise = |bit_error_rate| Faults {
        bit_error_rate,
        ..none
    };
    let late = |ms| Faults {
        delay: Duration::from_millis(ms),
        ..none
    };
    let late_b = || vec![of_b("Late", "side")];
    let mut kinds = vec![
        Kind::new("nothing_is_wrong", none, both, vec![json!("Works")]),
        Kind::new("noise", noise(1e-4), both, works()),
        Kind::new(
            "a_noisy_wire",
            noise(8e-4),
            both,
            [works(), vec![bad()]].concat(),
        ),
        Kind::new(
            "an_open_wire",
            Faults {
                is_deaf: true,
                ..none
            },
            partner,
            vec![json!({ "NotHeard": { "speaker": "A", "listener": "B" } })],
        ),
        Kind::new(
            "a_dead_side",
            Faults {
                is_dead: true,
                ..none
            },
            gateway,
            vec![of_b("NoAnswer", "silent")],
        ),
        Kind::new(
            "another_bcc",
            Faults {
                bcc_change: [0x03, 0x03],
                ..none
            },
            partner,
            vec![of_b("OtherBcc", "sender")],
        ),
        Kind::new("late_answers", late(2600), gateway, late_b()),
        Kind {
            qvz_ms: 550,
            ..Kind::new("late_for_a_short_qvz", late(900), gateway, late_b())
        },
        Kind::new(
            "pauses",
            Faults {
                pause: Duration::from_millis(400),
                ..none
            },
            partner,
            vec![of_b("Gaps", "sender")],
        ),
        Kind::new(
            "no_receive_buffer",
            Faults {
                keeps_telegrams: true,
                ..none
            },
            gateway,
            vec![of_b("NoReceiveBuffer", "refuser")],
        ),
        Kind::new(
            "a_bad_receiver",
            Faults {
                receiver_error_rate: 0.15,
                ..none
            },
            gateway,
            vec![of_b("GoodBlocksRejected", "refuser")],
        ),
        Kind::new(
            "own_echo",
            Faults {
                hears_itself: true,
                ..none
            },
            both,
            vec![of_b("OwnEcho", "side")],
        ),
        Kind {
            dies: true,
            ..Kind::new(
                "a_side_that_dies",
                none,
                both,
                vec![of_b("NoLongerAnswers", "silent")],
            )
        },
        Kind {
            priority: Priority::Low,
            ..Kind::new(
                "the_same_priority",
                none,
                both,
                vec![json!({ "SamePriority": { "priority": "Low" } })],
            )
        },
        Kind {
            config: Config::siemens_3964,
            ..Kind::new("without_bcc", none, both, vec![of_b("WithoutBcc", "side")])
        },
        Kind {
            config: Config::siemens_3964,
            preset: "siemens-3964",
            qvz_ms: 550,
            ..Kind::new("late_answers_of_3964", late(900), gateway, late_b())
        },
        Kind {
            telegram: |number| match number % 3 {
                0 => vec![0x57, number | 0x80],
                1 => vec![0x57, 0x10, 0x03, 0x42, 0x43],
                _ => vec![0x57, 0x10, 0x41, 0x42, 0x43],
            },
            ..Kind::new(
                "undoubled_dle",
                Faults {
                    doubles_no_dle: true,
                    ..none
                },
                partner,
                vec![of_b("NotDoubled", "sender")],
            )
        },
        Kind {
            telegram: |number| match number % 2 {
                0 => vec![0x57, number | 0x80],
                _ => vec![0x57, number | 0x80, 0x10, 0x41],
            },
            ..Kind::new(
                "the_same_damage",
                Faults {
                    bcc_change: [0x5A, 0],
                    ..none
                },
                partner,
                vec![of_b("SameDamage", "sender")],
            )
        },
        Kind {
            wire: Wire::Open,
            ..Kind::new(
                "both_wires_open",
                Faults {
                    is_deaf: true,
                    ..none
                },
                both,
                // Who is at one end hears nothing, whatever the other does.
                vec![json!("NeitherHears"), of_b("NoAnswer", "silent")],
            )
        },
        Kind {
            wire: Wire::Shared,
            ..Kind::new(
                "own_echo_of_the_gateway",
                none,
                both,
                vec![json!("Echo"), json!({ "OwnEcho": { "side": "A" } })],
            )
        },
    ];
    for (name, frame, right) in [
        ("no_parity", frame(9600, Parity::None), "NoParity"),
        ("odd_parity", frame(9600, Parity::Odd), "OtherParity"),
        ("another_rate", frame(4800, Parity::Even), "OtherRate"),
        ("a_higher_rate", frame(19_200, Parity::Even), "OtherRate"),
    ] {
        let right = vec![of_b(right, "side"), of_b("Garbage", "side")];
        kinds.push(Kind {
            frame,
            ..Kind::new(name, none, both, right)
        });
    }
    kinds
}

/// What a tap of both wires hears: as `line3964r monitor` would.
type Heard = Arc<Mutex<Vec<Character>>>;

/// The simulated line in real time, behind a serial server.
async fn serve(listener: TcpListener, mut bench: Bench, kind: &Kind, tap: Heard) {
    let (dies, faults, wire) = (kind.dies, kind.faults, kind.wire);
    let character = Duration::from_secs(Frame::USUAL.bits().into()) / 9600;
    let (stream, _) = listener.accept().await.unwrap();
    stream.set_nodelay(true).unwrap();
    let (mut from_gateway, mut to_gateway) = stream.into_split();
    let begin = Instant::now();
    let mut ticks = interval(Duration::from_millis(1));
    ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
    let mut piece = [0; 256];
    let (mut lives, mut busy_until) = (true, Duration::ZERO);
    let hears = |at, side, byte| {
        let error = None;
        let heard = Character {
            at,
            side,
            byte,
            error,
        };
        tap.lock().unwrap().push(heard);
    };
    loop {
        let mut heard = Vec::new();
        tokio::select! {
            _ = ticks.tick() => {}
            len = from_gateway.read(&mut piece) => match len {
                Ok(len @ 1..) => for &byte in &piece[..len] {
                    bench.send(byte);
                    // The time of the wires, which is late where the computer was.
                    busy_until = busy_until.max(bench.now()) + character;
                    hears(busy_until, Side::A, byte);
                    if wire == Wire::Shared {
                        hears(busy_until, Side::B, byte);
                        heard.push(byte);
                    }
                },
                _ => return,
            },
        }
        if dies && lives && begin.elapsed() > DEATH {
            lives = false;
            bench.set_faults(Faults {
                is_dead: true,
                ..faults
            });
        }
        while let Some((byte, error)) = bench.hear(begin.elapsed()) {
            let byte = if error.is_some() { 0 } else { byte };
            hears(bench.now(), Side::B, byte);
            heard.push(byte);
        }
        if wire != Wire::Open && !heard.is_empty() && to_gateway.write_all(&heard).await.is_err() {
            return;
        }
    }
}

/// What a monitor says of the line that it has heard.
fn by_monitor(kind: &Kind, tap: &Heard) -> Value {
    let mut heard = tap.lock().unwrap().clone();
    heard.sort_by_key(|heard| heard.at);
    serde_json::to_value(diagnose(&heard, &kind.expected())).unwrap()
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
#[ignore = "a minute in real time"]
async fn faults_of_simulated_partners() {
    let broker = broker_or_skip!();
    let mut config = format!("name = \"hall\"\n{}", mqtt(broker.port));
    let kinds = Arc::new(kinds());
    let mut taps = Vec::new();
    for (seed, index) in (1..).zip(0..kinds.len()) {
        let listener = listen();
        config += &kinds[index].line(listener.local_addr().unwrap().port());
        let (kinds, tap) = (Arc::clone(&kinds), Heard::default());
        taps.push(Arc::clone(&tap));
        tokio::spawn(async move {
            let kind = &kinds[index];
            serve(listener, kind.bench(seed), kind, tap).await;
        });
    }
    let mut subscriber = Subscriber::new(broker.port).await;
    let gateway = Gateway::start(&config);
    gateway.logs("broker: connected");
    let (begin, mut found) = (Instant::now(), BTreeMap::new());
    while begin.elapsed() < Duration::from_secs(SECONDS) {
        for kind in kinds.iter().filter(|kind| kind.sends[0]) {
            let topic = format!("line3964r/hall/{}/command", kind.name);
            let command = r#"{"send": "41 10 42 43"}"#;
            subscriber.publish(&topic, QoS::AtLeastOnce, command).await;
        }
        let step = Instant::now();
        while let Some(rest) = GATEWAY_SENDS.checked_sub(step.elapsed()) {
            if let Some((topic, payload)) = subscriber.next_within(rest).await
                && let Some(name) = topic.strip_suffix("/verdict")
            {
                let told: Value = serde_json::from_slice(&payload).unwrap();
                found.insert(name.rsplit('/').next().unwrap().to_owned(), told);
            }
        }
    }
    let (mut right, mut right_by_monitor) = (0, 0);
    for (kind, tap) in kinds.iter().zip(&taps) {
        let told = found.get(kind.name).cloned().unwrap_or_default();
        let by_monitor = by_monitor(kind, tap);
        // Where both look the same, also as the second cause.
        let are_right = [&told, &by_monitor]
            .map(|told| kind.is_right(&told["verdict"]) || kind.is_right(&told["or"]));
        right += usize::from(are_right[0]);
        right_by_monitor += usize::from(are_right[1]);
        let [gateway, monitor] = are_right.map(|is_right| if is_right { "right" } else { "WRONG" });
        let name = kind.name;
        println!("{name:<22} {gateway}  {}", told["sentence"]);
        println!(
            "{:<22} {monitor}  {}",
            "    a monitor", by_monitor["verdict"]
        );
    }
    let count = kinds.len();
    println!("of {count} lines the gateway is right on {right}, a monitor on {right_by_monitor}");
    assert!(right * 10 >= count * 9, "{}", gateway.log());
}
