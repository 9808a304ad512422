//! Round trips, and arbitrary blocks in arbitrary order.

use core::time::Duration;

use proptest::prelude::*;
use rk512::{
    Area, AreaKind, Command, Config, Continuation, Coordination, CoordinationFlag, Cpu, DataBlock,
    Endpoint, Event, MAX_DATA, Memory, Message, Part, Reaction, ReactionError,
};

fn coordination() -> impl Strategy<Value = Coordination> {
    let flag = prop::option::of((0u8..=254, 0u8..8));
    let cpus = vec![Cpu::One, Cpu::Two, Cpu::Three, Cpu::Four];
    let cpu = prop::option::of(prop::sample::select(cpus));
    (flag, cpu).prop_map(|(flag, cpu)| Coordination {
        flag: flag.map(|(byte, bit)| CoordinationFlag::new(byte, bit).unwrap()),
        cpu,
    })
}

fn command() -> impl Strategy<Value = Command> {
    let kinds: Vec<_> = (0..=u8::MAX).filter_map(AreaKind::from_code).collect();
    let kind = prop::sample::select(kinds);
    let parts = (any::<bool>(), kind, any::<u8>(), any::<u8>(), 1u16..);
    (parts, coordination()).prop_map(|((send, kind, number, start, length), coordination)| {
        let numbered = Area::new(kind, number, start);
        let area = numbered.or_else(|_| Area::new(kind, 0, start)).unwrap();
        Command::send(area, length)
            .ok()
            .filter(|_| send)
            .or_else(|| Command::fetch(area, length).ok())
            .unwrap()
            .with_coordination(coordination)
    })
}

fn data() -> impl Strategy<Value = Vec<u8>> {
    prop::collection::vec(any::<u8>(), 0..=MAX_DATA)
}

/// Blocks near to telegrams: a good header with some bytes replaced, and data of any length.
fn block() -> impl Strategy<Value = Vec<u8>> {
    let noise = prop::collection::vec(any::<u8>(), 0..200);
    let near = (command(), 0usize..=3, data(), any::<(u8, u8)>());
    let near = near.prop_map(|(command, kind, data, (at, value))| {
        let mut block = match kind {
            0 => <[u8; 10]>::from(command).to_vec(),
            1 => {
                let continuation = Continuation::new(command.request());
                continuation.telegram(&[]).unwrap().to_vec()
            }
            2 => vec![0, 0, 0, at % 3],
            _ => vec![0xFF, 0, 0, at % 3],
        };
        block.extend(data);
        if let Some(byte) = block.get_mut(usize::from(at)) {
            *byte = value;
        }
        block
    });
    prop_oneof![noise, near]
}

proptest! {
    #[test]
    fn commands_round_trip(command in command(), fill in any::<u8>()) {
        let first = if command.is_send() { command.byte_len().min(MAX_DATA) } else { 0 };
        let data = vec![fill; first];
        let telegram = command.telegram(&data).unwrap();
        prop_assert_eq!(Command::decode(&telegram), Ok((command, &data[..])));
        prop_assert_eq!(Command::try_from(<[u8; 10]>::from(command)), Ok(command));
    }

    #[test]
    fn continuations_round_trip(command in command(), data in data()) {
        let data = if command.is_send() { data } else { Vec::new() };
        let continuation = Continuation::new(command.request());
        let telegram = continuation.telegram(&data).unwrap();
        prop_assert_eq!(Continuation::decode(&telegram), Ok((continuation, &data[..])));
    }

    #[test]
    fn reactions_round_trip(first in any::<bool>(), code in any::<u8>(), data in data()) {
        let part = if first { Part::First } else { Part::Continuation };
        let result = ReactionError::from_code(code).map_or(Ok(()), Err);
        let reaction = Reaction { part, result };
        let telegram = reaction.telegram(&data).unwrap();
        prop_assert_eq!(Reaction::decode(&telegram), Ok((reaction, &data[..])));
        prop_assert_eq!(telegram[3], code);
    }

    #[test]
    fn whatever_decodes_encodes_to_the_same_bytes(block in block()) {
        if let Ok(message) = Message::decode(&block) {
            let telegram = message.encode().unwrap();
            prop_assert_eq!(&*telegram, &block[..]);
        }
    }

    /// Any blocks, reports and times, in any order: no panic, and after silence no job.
    #[test]
    fn arbitrary_input_leaves_nothing_stuck(
        inputs in prop::collection::vec((0u8..8, block(), 0u64..30_000), 0..60),
    ) {
        let (mut db5, mut flags) = ([0; 400], [0; 255]);
        let mut plc = Memory {
            flags: &mut flags,
            ..Memory::new([DataBlock::db(5, &mut db5)])
        };
        let fetch = Command::fetch(Area::db(5, 0), 150).unwrap();
        let own = |event: Option<Event<'_>>| u32::from(matches!(event, Some(Event::Own(_))));
        let mut endpoint = Endpoint::<300>::new(Config::DEFAULT);
        let (mut now, mut jobs, mut outcomes) = (Duration::ZERO, 0, 0);
        for (input, block, millis) in inputs {
            match input {
                0 => endpoint.handle_delivered(now),
                1 => endpoint.handle_failed(now, &mut plc),
                2 => now += Duration::from_millis(millis),
                3 => jobs += u32::from(endpoint.submit(fetch, &[]).is_ok()),
                4 => drop(endpoint.poll_transmit(now)),
                5 => endpoint.cancel(now),
                _ => endpoint.handle_block(now, &block, &mut plc),
            }
            endpoint.handle_timeout(now, &mut plc);
            outcomes += own(endpoint.poll_event()) + own(endpoint.poll_event());
        }
        for _ in 0..8 {
            let _telegram = endpoint.poll_transmit(now);
            endpoint.handle_delivered(now);
            now += Duration::from_secs(30);
            endpoint.handle_timeout(now, &mut plc);
            outcomes += own(endpoint.poll_event()) + own(endpoint.poll_event());
        }
        prop_assert_eq!(outcomes, jobs);
        prop_assert!(!endpoint.is_busy() && endpoint.poll_transmit(now).is_none());
        prop_assert_eq!(endpoint.poll_timeout(), None);
    }
}
