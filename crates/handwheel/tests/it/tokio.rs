//! The pendant over streams of tokio, against a simulated unit.

use core::time::Duration;
use std::io::ErrorKind;

use handwheel::{
    Command, Event, LcdAnswer, LcdBlock, LcdCommand, Led, LedState, Model, Position, Report,
    RotarySwitch, Status, SubmitError, Text, Timeouts,
    tokio::{Pendant, PendantError, connect},
};
use proto3964r::{
    Config, Line, Priority,
    tokio::{Link, SendError},
};
use tokio::{
    io::{AsyncReadExt as _, DuplexStream, duplex},
    net::TcpListener,
    task::JoinHandle,
    time::timeout,
};

const MODEL: Model = Model::Hbls;
const CONTROL: Config = Config::euchner_hbls(Line::Instant);
const UNIT: Config = Config {
    priority: Priority::Low,
    ..CONTROL
};
const STX: u8 = 0x02;
/// Longer than all attempts of a line that is dead.
const LONG: Duration = Duration::from_secs(60);

/// A unit at its end of a line, and what it was told until that ended.
struct Unit {
    line: Link,
    told: Vec<String>,
}

impl Unit {
    fn new(line: Link) -> Self {
        let told = Vec::new();
        Self { line, told }
    }

    async fn say(&self, report: Report) {
        let mut telegram = [0; 3];
        let telegram = report.encode(MODEL, &mut telegram).unwrap();
        self.line.send(telegram).await.unwrap();
    }

    /// One command; false at the end of the line.
    async fn answer(&mut self) -> bool {
        let Ok(telegram) = self.line.receive().await else {
            return false;
        };
        match Command::decode(MODEL, &telegram).unwrap() {
            Command::StatusRequest => {
                let (key, w1, w2) = (None, Position::MIN, Position::MIN);
                self.say(Report::Status(Status::Hbls { key, w1, w2 })).await;
            }
            Command::Lcd(_) => {
                self.told.push("block".into());
                self.say(Report::Lcd(LcdAnswer::NoSuchText)).await;
            }
            Command::Led { led, state } => self.told.push(format!("{led:?} {state:?}")),
            other => panic!("{other:?}"),
        }
        true
    }

    async fn work(mut self) -> Vec<String> {
        while self.answer().await {}
        self.told
    }
}

fn start(line: DuplexStream) -> JoinHandle<Vec<String>> {
    tokio::spawn(Unit::new(Link::new(line, UNIT)).work())
}

fn pendant(line: DuplexStream) -> Pendant {
    Pendant::new(line, CONTROL, MODEL, Timeouts::DEFAULT)
}

fn block(model: Model) -> LcdBlock {
    let mut block = LcdBlock::new(model);
    let text = LcdCommand::Text(Text::new("READY").unwrap());
    block.push(text).unwrap();
    block
}

/// The next event that is no status.
async fn event(pendant: &Pendant) -> Event {
    loop {
        match pendant.event().await.unwrap() {
            Event::Status { .. } => {}
            event => return event,
        }
    }
}

#[tokio::test]
async fn a_block_is_answered_and_an_led_set() {
    let (here, there) = duplex(64);
    let (pendant, unit) = (pendant(here), start(there));
    let (shown, lit) = tokio::join!(
        pendant.show(block(MODEL)),
        pendant.set_led(Some(Led::new(3).unwrap()), LedState::On)
    );
    assert_eq!(shown.unwrap(), LcdAnswer::NoSuchText);
    lit.unwrap();
    drop(pendant);
    let mut told = unit.await.unwrap();
    told.sort();
    assert_eq!(told, ["Some(Led(3)) On", "block"]);
}

#[tokio::test]
async fn over_tcp_the_status_is_asked_for_at_once() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let address = format!("tcp://{}", listener.local_addr().unwrap());
    let (pendant, accepted) = tokio::join!(connect(&address, MODEL), listener.accept());
    let mut line = accepted.unwrap().0;
    assert_eq!(line.read_u8().await.unwrap(), STX);
    drop(line);
    assert!(pendant.unwrap().event().await.is_err());
}

#[tokio::test(start_paused = true)]
async fn jobs_wait_for_the_pendant_and_none_is_another_models() {
    let (here, there) = duplex(64);
    let pendant = pendant(here);
    assert!(timeout(LONG, pendant.show(block(MODEL))).await.is_err());
    // The one that was given up is still to be done.
    let unit = tokio::spawn(async {
        tokio::time::sleep(LONG).await;
        Unit::new(Link::new(there, UNIT)).work().await
    });
    let refused = pendant.show(block(Model::Hbas)).await;
    let model = MODEL;
    assert!(
        matches!(refused, Err(PendantError::Refused(SubmitError::Model { model: own })) if own == model),
        "{refused:?}"
    );
    drop(pendant);
    assert_eq!(unit.await.unwrap(), ["block"]);
}

#[tokio::test(start_paused = true)]
async fn no_event_is_missing_however_many_wait() {
    let (here, there) = duplex(64);
    let pendant = pendant(here);
    let positions = || (0..Pendant::QUEUE * 2).map(|number| 1 + number % 12);
    let unit = tokio::spawn(async move {
        let mut unit = Unit::new(Link::new(there, UNIT));
        assert!(unit.answer().await);
        for position in positions() {
            let position = Position::new(position.try_into().unwrap()).unwrap();
            let switch = RotarySwitch::W1;
            let mut telegram = [0; 3];
            let report = Report::RotarySwitch { switch, position };
            let telegram = report.encode(MODEL, &mut telegram).unwrap();
            // While nobody takes events, the line stands.
            while let Err(error) = unit.line.send(telegram).await {
                assert!(matches!(error, SendError::Failed(_)), "{error}");
            }
        }
        unit.work().await
    });
    tokio::time::sleep(LONG).await;
    let mut before = None;
    for position in positions() {
        // What was sent again may have arrived before.
        while before != Some(position) {
            match timeout(LONG, event(&pendant)).await.unwrap() {
                Event::RotarySwitch(_, next) => {
                    let next = usize::from(next.get());
                    assert!(
                        before == Some(next) || next == position,
                        "after {before:?}: {next}"
                    );
                    before = Some(next);
                }
                Event::Lost => {}
                other => panic!("{other:?}"),
            }
        }
    }
    drop(pendant);
    assert!(unit.await.unwrap().is_empty());
}

#[tokio::test(start_paused = true)]
async fn one_that_is_unplugged_is_said_to_be_lost_and_to_be_back() {
    let (here, there) = duplex(64);
    let pendant = pendant(here);
    let mut unit = Unit::new(Link::new(there, UNIT));
    assert!(unit.answer().await);
    let connected = pendant.event().await.unwrap();
    assert!(matches!(
        connected,
        Event::Status {
            connected: true,
            ..
        }
    ));
    // It takes requests, and does not answer.
    assert_eq!(event(&pendant).await, Event::Lost);
    let unit = tokio::spawn(unit.work());
    let back = pendant.event().await.unwrap();
    assert!(matches!(
        back,
        Event::Status {
            connected: true,
            ..
        }
    ));
    drop(pendant);
    unit.await.unwrap();
}

#[tokio::test]
async fn a_lost_connection_ends_every_call() {
    let (here, there) = duplex(64);
    let pendant = pendant(here);
    drop(there);
    let shown = pendant.show(block(MODEL)).await;
    assert!(
        matches!(&shown, Err(PendantError::Lost(lost)) if lost.kind() == ErrorKind::UnexpectedEof),
        "{shown:?}"
    );
    assert!(pendant.event().await.is_err());
    let unknown = connect("com1", MODEL).await.unwrap_err();
    assert_eq!(unknown.kind(), ErrorKind::InvalidInput);
}
