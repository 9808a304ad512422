//! What busy lines cost a gateway: the table of docs/book/src/fleet.md.

use core::{str::FromStr, time::Duration};
use std::env;

use proto3964r::tokio::SendError;
use tempfile::TempDir;
use tokio::{
    sync::watch,
    task::{JoinSet, spawn_blocking},
    time::{Instant, MissedTickBehavior, interval_at, sleep},
};

use super::{
    broker::Broker,
    listeners::free_ports,
    process::{Gateway, metric, mqtt},
    uart::{Answers, Pace, Uart},
};

/// Bytes of a telegram.
const TELEGRAM: usize = 32;

/// Until each line has been looked at for the first time: from then on every 15 minutes, if it
/// works.
const FIRST_LOOK: Duration = Duration::from_secs(7);

/// One row of the table.
struct Case {
    lines: u32,
    pace: Pace,
    /// From one telegram of a line to the next; without it, one follows the other.
    pause: Option<Duration>,
    /// Whether the gateway listens to its lines, for verdicts.
    diagnose: bool,
}

/// What a partner has to tell of its telegrams.
#[derive(Clone, Copy, Default)]
struct Told {
    sent: u32,
    failed: u32,
}

/// The words of an environment variable, or these.
fn words<T: FromStr>(name: &str, default: &str) -> Vec<T> {
    let text = env::var(name).unwrap_or_else(|_| default.to_owned());
    let parse = |word: &str| {
        word.parse()
            .unwrap_or_else(|_| panic!("{name}: `{word}` is no number"))
    };
    text.split_whitespace().map(parse).collect()
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
#[ignore = "measures for minutes, on Linux"]
async fn busy_lines() {
    println!(
        "| diagnose | bit/s | pieces | lines | telegrams/s | failed | CPU s/s | us/telegram | answers ms: 50 %, 99 %, all | MB | verdicts, % of CPU |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    let seconds = Duration::from_secs(words("GATEWAY_SECONDS", "10")[0]);
    for pause_s in words("GATEWAY_PAUSES_S", "1 0") {
        let pause = Some(Duration::from_secs(pause_s)).filter(|pause| !pause.is_zero());
        for baud in words("GATEWAY_BAUDS", "9600 115200") {
            for every_ms in words("GATEWAY_PIECES_MS", "16 1") {
                let every = Duration::from_millis(every_ms);
                let pace = Pace { baud, every };
                for lines in words("GATEWAY_LINES", "50 100 200 500") {
                    for diagnose in words("GATEWAY_DIAGNOSE", "true") {
                        let case = Case {
                            lines,
                            pace,
                            pause,
                            diagnose,
                        };
                        println!("{}", case.measure(seconds).await);
                    }
                }
            }
        }
    }
}

impl Case {
    /// Lets partners send through a gateway to a broker for this time, once all have begun.
    async fn measure(&self, time: Duration) -> String {
        let broker = Broker::start().expect("a broker");
        let folder = TempDir::new().unwrap();
        let [port] = free_ports();
        let mut config = format!(
            "name = \"hall\"\n{}[metrics]\nlisten = \"127.0.0.1:{port}\"\n",
            mqtt(broker.port)
        );
        let mut uarts = Vec::new();
        for index in 0..self.lines {
            let name = format!("line{index}");
            let uart = Uart::new(&folder.path().join(&name), self.pace).await;
            config += &uart.line(&name);
            config += &format!("diagnose = {}\n", self.diagnose);
            uarts.push(uart);
        }
        let gateway = Gateway::start(&config);
        for uart in &uarts {
            gateway.logs(&format!("{} is open", uart.address));
        }
        let (mut partners, mut told, mut answers) = (JoinSet::new(), Vec::new(), Vec::new());
        for (uart, index) in uarts.into_iter().zip(0..) {
            answers.push(uart.answers.clone());
            let (teller, hearer) = watch::channel(Told::default());
            told.push(hearer);
            let phase = self.pause.unwrap_or_default() * index / self.lines;
            partners.spawn(send(uart, self.pause, phase, teller));
        }
        for told in &mut told {
            told.wait_for(|told| told.sent > 0).await.unwrap();
        }
        if self.diagnose {
            sleep(FIRST_LOOK).await;
        }

        let total = || {
            told.iter().fold(Told::default(), |sum, told| Told {
                sent: sum.sent + told.borrow().sent,
                failed: sum.failed + told.borrow().failed,
            })
        };
        answers.iter().for_each(|answers| drop(answers.take()));
        let (begin, before, cpu) = (Instant::now(), total(), gateway.cpu_s());
        sleep(time).await;
        let (after, cpu) = (total(), gateway.cpu_s() - cpu);
        let elapsed = begin.elapsed().as_secs_f64();
        let memory = gateway.resident_mb();
        let lines = self.lines;
        let verdicts = spawn_blocking(move || {
            let of = |line| format!("line3964r_line_verdict_us_total{{line=\"line{line}\"}}");
            (0..lines).map(|line| metric(port, &of(line))).sum::<u64>()
        });
        let verdicts = Duration::from_micros(verdicts.await.unwrap()).as_secs_f64();
        // Since the start: each line's first look is in it.
        let verdicts = verdicts / gateway.cpu_s() * 100.0;
        let mut times: Vec<_> = answers.iter().flat_map(Answers::take).collect();
        times.sort_unstable();

        gateway.ends();
        drop(partners);
        let sent = f64::from(after.sent - before.sent);
        let at = |percent: usize| times[(times.len() - 1) * percent / 100].as_secs_f64() * 1e3;
        format!(
            "| {} | {} | {:?} | {} | {:.0} | {} | {:.3} | {:.0} | {:.1}, {:.1}, {:.1} | {memory:.1} | {verdicts:.1} |",
            self.diagnose,
            self.pace.baud,
            self.pace.every,
            self.lines,
            sent / elapsed,
            after.failed - before.failed,
            cpu / elapsed,
            cpu / sent * 1e6,
            at(50),
            at(99),
            at(100),
        )
    }
}

/// Sends telegrams with their numbers until the test ends.
async fn send(uart: Uart, pause: Option<Duration>, phase: Duration, teller: watch::Sender<Told>) {
    let mut due = pause.map(|pause| interval_at(Instant::now() + phase, pause));
    if let Some(due) = &mut due {
        due.set_missed_tick_behavior(MissedTickBehavior::Skip);
    }
    for number in 0_u32.. {
        if let Some(due) = &mut due {
            due.tick().await;
        }
        let mut telegram = number.to_be_bytes().to_vec();
        telegram.resize(TELEGRAM, b'0');
        let result = uart.link.send(&telegram).await;
        teller.send_modify(|told| match result {
            Ok(()) => told.sent += 1,
            Err(SendError::Failed(_)) => told.failed += 1,
            Err(error) => panic!("{error}"),
        });
    }
}
