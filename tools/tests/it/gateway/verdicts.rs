//! Lines with faults of `line-sim`, each on a partner of its own: the gateway names them.

use alloc::collections::BTreeMap;
use core::time::Duration;

use proto3964r::{Config, Line, Priority, tokio::Link};
use rumqttc::v5::mqttbytes::QoS;
use serde_json::{Value, json};
use tempfile::TempDir;
use tokio::{
    io::{AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _, duplex, split},
    net::TcpListener,
    sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel},
    task::JoinSet,
    time::{Instant, sleep, sleep_until},
};

use super::{
    broker_or_skip,
    listeners::listen,
    partner::PARTNER,
    process::{Gateway, PATIENCE, line, mqtt},
    subscriber::Subscriber,
    uart::{Pace, Uart},
};

/// From one telegram of a side to the next.
const PAUSE: Duration = Duration::from_millis(150);

/// How late the answers of one are.
const LATE: Duration = Duration::from_millis(900);

/// From one telegram to the next that it is sent: what comes after silence shows what it answers.
const RARELY: Duration = Duration::from_secs(6);

/// Before the first of them: after the NAK that opens a line, no answer is due any more.
const SILENCE: Duration = Duration::from_millis(600);

/// What is wrong with a partner.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Fault {
    None,
    Dead,
    Deaf,
    /// Changes each BCC.
    Bcc(u8),
    /// 3964 in place of 3964R.
    WithoutBcc,
    /// No receive buffer.
    Refuses,
    /// Answers come after the gateway's QVZ of 500 ms.
    Late,
}

/// A line, who sends on it, and its verdict.
struct Case {
    name: &'static str,
    fault: Fault,
    gateway_sends: bool,
    partner_sends: bool,
    /// The name of the verdict, and what it says of the sides.
    verdict: Value,
}

/// All but one are over TCP, where characters take no time.
fn cases() -> Vec<Case> {
    let case = |name, fault, [gateway_sends, partner_sends]: [bool; 2], verdict| Case {
        name,
        fault,
        gateway_sends,
        partner_sends,
        verdict,
    };
    let both = [true, true];
    let (gateway, partner) = ([true, false], [false, true]);
    let not_heard = json!({ "NotHeard": { "speaker": "A", "listener": "B" } });
    vec![
        case("good", Fault::None, both, json!("Works")),
        case(
            "dead",
            Fault::Dead,
            gateway,
            json!({ "NoAnswer": { "silent": "B" } }),
        ),
        case("deaf", Fault::Deaf, partner, not_heard),
        case(
            "bcc",
            Fault::Bcc(0x55),
            partner,
            json!({ "OtherBcc": { "sender": "B" } }),
        ),
        case(
            "r",
            Fault::WithoutBcc,
            both,
            json!({ "WithoutBcc": { "side": "B" } }),
        ),
        case(
            "late",
            Fault::Late,
            gateway,
            json!({ "Late": { "side": "B" } }),
        ),
        case(
            "full",
            Fault::Refuses,
            gateway,
            json!({ "NoReceiveBuffer": { "refuser": "B" } }),
        ),
    ]
}

impl Case {
    /// Whether a verdict is of the right kind and about the right side.
    fn fits(&self, found: &Value) -> bool {
        let Some(expected) = self.verdict.as_object() else {
            // On a busy computer an answer may be late now and then.
            return *found == self.verdict || found.get("WorksWithRepeats").is_some();
        };
        expected.iter().all(|(name, fields)| {
            let fields = fields.as_object().unwrap();
            fields
                .iter()
                .all(|(field, value)| found[name][field] == *value)
        })
    }

    /// The partner at the other end of a line.
    async fn partner(fault: Fault, sends: bool, listener: TcpListener) {
        let (stream, _) = listener.accept().await.unwrap();
        stream.set_nodelay(true).unwrap();
        let (mut from_gateway, mut to_gateway) = stream.into_split();
        if fault == Fault::Refuses {
            while let Ok(byte) = from_gateway.read_u8().await {
                if byte == 0x02 {
                    to_gateway.write_u8(0x15).await.unwrap();
                }
            }
            return;
        }
        let config = match fault {
            Fault::WithoutBcc => Config {
                qvz_ms: PARTNER.qvz_ms,
                ..Config::siemens_3964(Priority::High, Line::Instant)
            },
            _ => PARTNER,
        };
        let (here, there) = duplex(4096);
        let (from_partner, to_partner) = split(there);
        let link = Link::new(here, config);
        let hears = carry(from_gateway, to_partner, fault, true);
        if fault == Fault::Late {
            let (heard, late) = unbounded_channel();
            let delays = delay(from_partner, heard);
            let says = say_late(late, to_gateway);
            tokio::join!(hears, delays, says, talk(&link, sends));
        } else {
            let says = carry(from_partner, to_gateway, fault, false);
            tokio::join!(hears, says, talk(&link, sends));
        }
    }
}

/// Sends telegrams if it is to, and takes those that come.
async fn talk(link: &Link, sends: bool) {
    let sending = async {
        for number in (0..100).cycle() {
            sleep(PAUSE).await;
            if sends {
                link.send(&[0x57, number, 0x33]).await.ok();
            }
        }
    };
    let receiving = async { while link.receive().await.is_ok() {} };
    tokio::join!(sending, receiving);
}

/// Carries characters to the partner, or from it, as the fault has it.
async fn carry(
    mut from: impl AsyncRead + Unpin,
    mut to: impl AsyncWrite + Unpin,
    fault: Fault,
    is_to_partner: bool,
) {
    let mut last = [0; 2];
    while let Ok(byte) = from.read_u8().await {
        let is_bcc = last == [0x10, 0x03];
        last = if is_bcc { [0; 2] } else { [last[1], byte] };
        let carried = match (fault, is_to_partner) {
            (Fault::Dead, _) | (Fault::Deaf, true) => continue,
            (Fault::Bcc(change), false) if is_bcc => byte ^ change,
            _ => byte,
        };
        if to.write_u8(carried).await.is_err() {
            return;
        }
    }
}

/// Until when each character waits.
async fn delay(mut from: impl AsyncRead + Unpin, to: UnboundedSender<(Instant, u8)>) {
    while let Ok(byte) = from.read_u8().await {
        if to.send((Instant::now() + LATE, byte)).is_err() {
            return;
        }
    }
}

async fn say_late(mut from: UnboundedReceiver<(Instant, u8)>, mut to: impl AsyncWrite + Unpin) {
    while let Some((at, byte)) = from.recv().await {
        sleep_until(at).await;
        if to.write_u8(byte).await.is_err() {
            return;
        }
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn faults_of_partners_are_named() {
    let broker = broker_or_skip!();
    let mut config = format!("name = \"hall\"\n{}", mqtt(broker.port));
    let (mut cases, mut partners) = (cases(), JoinSet::new());
    for case in &cases {
        let listener = listen();
        config += &line(case.name, listener.local_addr().unwrap().port());
        partners.spawn(Case::partner(case.fault, case.partner_sends, listener));
    }
    // One whose characters need their time.
    let folder = TempDir::new().unwrap();
    let pace = Pace {
        baud: 9600,
        every: Duration::from_millis(1),
    };
    let uart = Uart::new(&folder.path().join("slow"), pace).await;
    config += &uart.line("slow");
    partners.spawn(async move { talk(&uart.link, true).await });
    cases.push(Case {
        name: "slow",
        fault: Fault::None,
        gateway_sends: true,
        partner_sends: true,
        verdict: json!("Works"),
    });

    let mut subscriber = Subscriber::new(broker.port).await;
    let gateway = Gateway::start(&config);
    gateway.logs("broker: connected");
    let (begin, mut found) = (Instant::now(), BTreeMap::new());
    let is_right = |found: &BTreeMap<String, Value>, case: &Case| {
        found
            .get(case.name)
            .is_some_and(|found| case.fits(&found["verdict"]))
    };
    let mut rare_at = begin + SILENCE;
    while !cases.iter().all(|case| is_right(&found, case)) {
        for case in cases.iter().filter(|case| case.gateway_sends) {
            if case.fault == Fault::Late {
                if Instant::now() < rare_at {
                    continue;
                }
                rare_at += RARELY;
            }
            let topic = format!("line3964r/hall/{}/command", case.name);
            subscriber
                .publish(&topic, QoS::AtLeastOnce, r#"{"send": "41 42 43"}"#)
                .await;
        }
        let step = Instant::now();
        while step.elapsed() < PAUSE {
            if let Some((topic, payload)) = subscriber.next_within(PAUSE).await
                && let Some(name) = topic.strip_suffix("/verdict")
            {
                let name = name.rsplit('/').next().unwrap().to_owned();
                found.insert(name, serde_json::from_slice(&payload).unwrap());
            }
        }
        assert!(begin.elapsed() < PATIENCE, "{found:#?}\n{}", gateway.log());
    }
    for case in &cases {
        let report = &found[case.name];
        assert_eq!(report["is_fault"], report["verdict"] != "Works", "{report}");
        assert!(gateway.log().contains(report["sentence"].as_str().unwrap()));
    }
}
