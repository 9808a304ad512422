//! Both sides on one line: the quasi-duplex case.

use core::time::Duration;

use rk512::{Area, Command, Config, DataBlock, Endpoint, Event, Memory, Outcome, ServerEvent};

const NOW: Duration = Duration::from_millis(1);
const PARTNER_SEND: [u8; 12] = [0, 0, 0x41, 0x44, 5, 0, 0, 1, 0xFF, 0xFF, 0x12, 0x34];

fn fetch() -> Command {
    Command::fetch(Area::db(7, 0), 1).unwrap()
}

#[test]
fn the_partners_command_before_the_reaction_to_mine() {
    let mut db5 = [0; 2];
    let mut plc = Memory::new([DataBlock::db(5, &mut db5)]);
    let mut endpoint = Endpoint::<16>::new(Config::DEFAULT);
    endpoint.submit(fetch(), &[]).unwrap();
    assert!(endpoint.poll_transmit(NOW).is_some());
    endpoint.handle_delivered(NOW);

    endpoint.handle_block(NOW, &PARTNER_SEND, &mut plc);
    let reaction = endpoint.poll_transmit(NOW).unwrap();
    assert_eq!(*reaction, [0, 0, 0, 0]);
    endpoint.handle_delivered(NOW);
    let event = endpoint.poll_event();
    assert!(matches!(
        event,
        Some(Event::Partner(ServerEvent::Served(_)))
    ));
    let reaction_due = NOW + Duration::from_secs(20);
    assert_eq!(endpoint.poll_timeout(), Some(reaction_due));

    endpoint.handle_block(NOW, &[0, 0, 0, 0, 0xAB, 0xCD], &mut plc);
    let outcome = endpoint.poll_event();
    assert!(matches!(
        outcome,
        Some(Event::Own(Outcome::Fetched {
            data: [0xAB, 0xCD],
            ..
        }))
    ));
    assert_eq!(db5, [0x12, 0x34]);
}

/// Nesting depth 1: the second command comes before my reaction is away.
#[test]
fn the_partners_second_command_before_my_reaction() {
    let mut db5 = [0; 2];
    let mut plc = Memory::new([DataBlock::db(5, &mut db5)]);
    let mut endpoint = Endpoint::<16>::new(Config::DEFAULT);
    endpoint.submit(fetch(), &[]).unwrap();
    assert!(endpoint.poll_transmit(NOW).is_some());
    endpoint.handle_block(NOW, &PARTNER_SEND, &mut plc);
    assert!(endpoint.poll_transmit(NOW).is_none(), "one block at a time");
    endpoint.handle_block(NOW, &PARTNER_SEND, &mut plc);
    endpoint.handle_delivered(NOW);
    assert_eq!(*endpoint.poll_transmit(NOW).unwrap(), [0, 0, 0, 0x36]);
}

#[test]
fn reactions_go_out_before_commands() {
    let mut db5 = [0; 2];
    let mut plc = Memory::new([DataBlock::db(5, &mut db5)]);
    let mut endpoint = Endpoint::<16>::new(Config::DEFAULT);
    endpoint.handle_block(NOW, &PARTNER_SEND, &mut plc);
    endpoint.submit(fetch(), &[]).unwrap();
    assert_eq!(endpoint.poll_transmit(NOW).unwrap()[2], 0);
    endpoint.handle_delivered(NOW);
    assert_eq!(endpoint.poll_transmit(NOW).unwrap()[2], 0x45);
    endpoint.handle_delivered(NOW);
    assert!(endpoint.poll_transmit(NOW).is_none());
}

/// A block that is too short to tell fails the own job, else it is answered.
#[test]
fn a_stub_goes_where_something_is_due() {
    let mut plc = Memory::new([]);
    let mut endpoint = Endpoint::<16>::new(Config::DEFAULT);
    endpoint.handle_block(NOW, &[], &mut plc);
    assert_eq!(*endpoint.poll_transmit(NOW).unwrap(), [0, 0, 0, 0x34]);
    let event = endpoint.poll_event();
    assert!(matches!(
        event,
        Some(Event::Partner(ServerEvent::Refused(_)))
    ));
    endpoint.handle_delivered(NOW);
    endpoint.submit(fetch(), &[]).unwrap();
    assert!(endpoint.poll_transmit(NOW).is_some());
    endpoint.handle_delivered(NOW);
    endpoint.handle_block(NOW, &[0xFF], &mut plc);
    let outcome = endpoint.poll_event();
    assert!(matches!(outcome, Some(Event::Own(Outcome::Failed { .. }))));
    assert!(endpoint.poll_transmit(NOW).is_none());
}
