//! The order of requests and replies.

use core::time::Duration;

use handwheel::{
    DecodeError, Driver, Event, Failure, Job, Key, LcdAnswer, LcdBlock, LcdCommand, Led, LedState,
    Model, Position, Status, SubmitError, Timeouts,
};
use proptest::prelude::*;

const STATUS: [u8; 1] = [0x23];
/// Released, both rotary switches at 1.
const REPLY: [u8; 3] = [0x30, 0x41, 0x51];

fn at(millis: u64) -> Duration {
    Duration::from_millis(millis)
}

fn home(model: Model) -> LcdBlock {
    let mut block = LcdBlock::new(model);
    block.push(LcdCommand::Home).unwrap();
    block
}

fn led(state: LedState) -> Job {
    let led = Led::new(1).ok();
    Job::Led { led, state }
}

fn sent(driver: &mut Driver, now: Duration) -> Vec<u8> {
    driver.poll_transmit(now).unwrap_or_default().to_vec()
}

/// What came of a push, after which there is nothing more.
fn event(driver: &mut Driver) -> Option<Event> {
    let event = driver.poll_event();
    assert_eq!(driver.poll_event(), None);
    event
}

fn delivered(driver: &mut Driver, now: Duration) -> Option<Event> {
    driver.handle_delivered(now);
    event(driver)
}

fn failed(driver: &mut Driver, now: Duration) -> Option<Event> {
    driver.handle_failed(now);
    event(driver)
}

fn timeout(driver: &mut Driver, now: Duration) -> Option<Event> {
    driver.handle_timeout(now);
    event(driver)
}

fn block(driver: &mut Driver, now: Duration, telegram: &[u8]) -> Option<Event> {
    driver.handle_block(now, telegram);
    event(driver)
}

fn assert_connects(driver: &mut Driver, now: Duration, reply: &[u8]) {
    let event = block(driver, now, reply);
    assert!(matches!(event, Some(Event::Status { connected, .. }) if connected));
}

fn online(model: Model) -> Driver {
    let mut driver = Driver::new(model, Timeouts::DEFAULT);
    assert_eq!(sent(&mut driver, at(0)), STATUS);
    assert_eq!(delivered(&mut driver, at(0)), None);
    let reply: &[u8] = match model {
        Model::Hbas => &[0x30, 0x31],
        _ => &REPLY,
    };
    assert_connects(&mut driver, at(0), reply);
    driver
}

#[test]
fn the_unit_is_dead_until_its_status_is_asked_for() {
    let mut driver = Driver::new(Model::Hbls, Timeouts::DEFAULT);
    driver.submit(led(LedState::On)).unwrap();
    assert_eq!(sent(&mut driver, at(0)), STATUS);
    assert_eq!(failed(&mut driver, at(400)), None);
    // Not at once: nobody may be there.
    assert!(sent(&mut driver, at(1399)).is_empty());
    assert_eq!(driver.poll_timeout(), Some(at(1400)));
    assert_eq!(sent(&mut driver, at(1400)), STATUS);
    assert_eq!(delivered(&mut driver, at(1410)), None);
    // Nothing between request and reply.
    assert!(sent(&mut driver, at(1420)).is_empty());
    let (w1, w2) = (Position::MIN, Position::MIN);
    let status = Status::Hbls { key: None, w1, w2 };
    let connected = true;
    let event = block(&mut driver, at(1450), &REPLY);
    assert_eq!(event, Some(Event::Status { status, connected }));
    assert!(driver.is_online());
    assert_eq!(sent(&mut driver, at(1450)), [0x31]);
    assert_eq!(delivered(&mut driver, at(1460)), Some(Event::LedDone));
    assert!(!driver.is_busy());
}

#[test]
fn a_display_block_waits_for_the_answer_before() {
    let mut driver = online(Model::Hbls);
    driver.submit(Job::Lcd(home(Model::Hbls))).unwrap();
    assert_eq!(sent(&mut driver, at(10)), [0x6C, 0x25]);
    assert_eq!(delivered(&mut driver, at(20)), None);
    assert_eq!(
        driver.submit(Job::Lcd(home(Model::Hbls))),
        Err(SubmitError::Busy)
    );
    // A key in between changes nothing.
    let key = Key::new(2).ok();
    assert_eq!(block(&mut driver, at(30), &[0x32]), Some(Event::Key(key)));
    assert!(sent(&mut driver, at(40)).is_empty());
    let (answer, status) = (LcdAnswer::BadParameter, None);
    let event = block(&mut driver, at(50), &[0x6C, 0x34]);
    assert_eq!(event, Some(Event::Lcd { answer, status }));
    assert!(!driver.is_busy());
    assert_eq!(driver.dropped(), 0);
    for dropped in 1..3 {
        assert_eq!(block(&mut driver, at(60), &[0x6C, 0x31]), None);
        assert_eq!(driver.dropped(), dropped);
    }
}

#[test]
fn a_status_request_follows_a_failure() {
    let mut driver = online(Model::Hbls);
    driver.submit(Job::Lcd(home(Model::Hbls))).unwrap();
    let _block = sent(&mut driver, at(10));
    let event = failed(&mut driver, at(20));
    assert_eq!(event, Some(Event::Failed(Failure::Transport)));
    driver.submit(Job::Lcd(home(Model::Hbls))).unwrap();
    assert_eq!(sent(&mut driver, at(20)), STATUS);
    assert_eq!(delivered(&mut driver, at(30)), None);
    // A reply that does not come, twice.
    assert_eq!(timeout(&mut driver, at(2029)), None);
    assert_eq!(timeout(&mut driver, at(2030)), Some(Event::Lost));
    assert!(!driver.is_online());
    assert_eq!(sent(&mut driver, at(3030)), STATUS);
    assert_eq!(failed(&mut driver, at(3040)), None);
    assert_eq!(sent(&mut driver, at(4040)), STATUS);
    assert_eq!(delivered(&mut driver, at(4050)), None);
    assert_connects(&mut driver, at(4060), &REPLY);
    assert_eq!(sent(&mut driver, at(4060)), [0x6C, 0x25]);
    assert_eq!(delivered(&mut driver, at(4070)), None);
    let event = timeout(&mut driver, at(6070));
    let failure = Failure::NoReply(Timeouts::DEFAULT.reply);
    assert_eq!(event, Some(Event::Failed(failure)));
    assert_eq!(sent(&mut driver, at(6070)), STATUS);
}

#[test]
fn the_hbas_answers_in_its_status() {
    let mut driver = online(Model::Hbas);
    driver.submit(Job::Lcd(home(Model::Hbas))).unwrap();
    assert_eq!(sent(&mut driver, at(10)), [0x6C, 0x25]);
    assert_eq!(delivered(&mut driver, at(20)), None);
    assert!(driver.is_busy());
    assert_eq!(sent(&mut driver, at(20)), STATUS);
    assert_eq!(delivered(&mut driver, at(30)), None);
    let event = block(&mut driver, at(40), &[0x44, 0x36]);
    let (lcd, key) = (LcdAnswer::AreaOverlap, Some(Key::MAX));
    let status = Some(Status::Hbas { key, lcd });
    let answer = lcd;
    assert_eq!(event, Some(Event::Lcd { answer, status }));
    assert!(!driver.is_busy());
}

#[test]
fn silence_is_looked_into_and_foreign_things_are_refused() {
    let mut driver = online(Model::Hbls);
    assert_eq!(driver.poll_timeout(), Some(at(2000)));
    assert!(block(&mut driver, at(500), &[0x45]).is_some());
    assert!(sent(&mut driver, at(2499)).is_empty());
    assert_eq!(sent(&mut driver, at(2500)), STATUS);
    let (index, byte) = (0, 0x7F);
    let unknown = DecodeError::Unknown { index, byte };
    let event = block(&mut driver, at(2600), &[byte]);
    assert_eq!(event, Some(Event::Unreadable(unknown)));
    let model = Model::Hbls;
    let foreign = SubmitError::Model { model };
    assert_eq!(driver.submit(Job::Lcd(home(Model::Hbas))), Err(foreign));
    assert!(online(Model::Hbas).submit(led(LedState::Off)).is_err());
    let mut driver = online(Model::Hbls);
    driver.submit(Job::Lcd(home(Model::Hbls))).unwrap();
    assert_eq!(sent(&mut driver, at(0)), [0x6C, 0x25]);
}

/// What the transport has, and what the unit owes, as a strict observer sees it.
#[derive(Default)]
struct Observer {
    in_transfer: Option<u8>,
    owed: Option<u8>,
    /// When that is too late.
    due: u64,
    must_ask: bool,
    jobs: i32,
}

proptest! {
    /// Any reports, replies and delays: one telegram at a time, nothing before a due reply,
    /// a status request first and after everything that failed, and every job ends once.
    #[test]
    fn any_course_keeps_the_order(
        hbas in any::<bool>(),
        inputs in prop::collection::vec((0u8..12, 0u64..3000), 1..200),
    ) {
        let model = if hbas { Model::Hbas } else { Model::Hbls };
        let mut driver = Driver::new(model, Timeouts::DEFAULT);
        let mut seen = Observer { must_ask: true, ..Observer::default() };
        let mut now = 0;
        for (input, millis) in inputs {
            let reply: &[u8] = if hbas { &[0x30, 0x31] } else { &REPLY };
            let event = match input {
                0 | 1 => {
                    let telegram = sent(&mut driver, at(now));
                    if let Some(&first) = telegram.first() {
                        prop_assert_eq!(seen.in_transfer, None);
                        prop_assert_eq!(seen.owed, None);
                        prop_assert!(!seen.must_ask || first == 0x23);
                        seen.in_transfer = Some(first);
                    }
                    None
                }
                2..=4 => {
                    let event = delivered(&mut driver, at(now));
                    seen.owed = match seen.in_transfer.take() {
                        Some(0x6C) if hbas => {
                            seen.must_ask = true;
                            None
                        }
                        Some(kind @ (0x23 | 0x6C)) => {
                            seen.due = now + 2000;
                            Some(kind)
                        }
                        _ => seen.owed,
                    };
                    event
                }
                5 => {
                    seen.must_ask |= seen.in_transfer.take().is_some();
                    failed(&mut driver, at(now))
                }
                6 | 7 => {
                    let event = block(&mut driver, at(now), reply);
                    if seen.owed == Some(0x23) {
                        seen.owed = None;
                        seen.must_ask = false;
                    }
                    event
                }
                8 => {
                    if !hbas && seen.owed == Some(0x6C) {
                        seen.owed = None;
                    }
                    block(&mut driver, at(now), &[0x6C, 0x31])
                }
                9 => {
                    now += millis;
                    let event = timeout(&mut driver, at(now));
                    if seen.owed.is_some() && seen.due <= now {
                        seen.owed = None;
                        seen.must_ask = true;
                    }
                    event
                }
                10 => {
                    seen.jobs += i32::from(driver.submit(Job::Lcd(home(model))).is_ok());
                    None
                }
                _ => {
                    seen.jobs += i32::from(driver.submit(Job::Led { led: None, state: LedState::On }).is_ok());
                    None
                }
            };
            let ended = matches!(event, Some(Event::LedDone | Event::Lcd { .. } | Event::Failed(_)));
            seen.jobs -= i32::from(ended);
            prop_assert!(seen.jobs == 0 || seen.jobs == 1);
            prop_assert_eq!(driver.is_busy(), seen.jobs != 0);
        }
    }
}

#[test]
fn sizes() {
    assert!(size_of::<Driver>() <= 288);
    assert!(size_of::<LcdBlock>() <= 144);
}
