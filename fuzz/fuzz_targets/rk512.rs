//! Any blocks, failures and delays in front of an RK512 endpoint: every job ends once.
#![no_main]

use std::time::Duration;

use libfuzzer_sys::fuzz_target;
use rk512::{Area, Command, Config, DataBlock, Endpoint, Event, Memory, Message};

// Records of two bytes (what happens, length) and a block of that length.
fuzz_target!(|data: &[u8]| {
    let mut input = data;
    if let Ok(message) = Message::decode(input) {
        assert_eq!(message.encode().as_deref(), Ok(input));
    }
    let (mut db5, mut flags) = ([0; 300], [0; 40]);
    let mut plc = Memory {
        flags: &mut flags,
        ..Memory::new([DataBlock::db(5, &mut db5)])
    };
    let mut endpoint = Endpoint::<300>::new(Config::DEFAULT);
    let mut now = Duration::ZERO;
    let (mut jobs, mut outcomes) = (0, 0);
    while let Some((&[happening, len], rest)) = input.split_first_chunk() {
        let (block, behind) = rest.split_at(rest.len().min(len.into()));
        input = behind;
        match happening % 9 {
            0 => endpoint.handle_delivered(now),
            1 => endpoint.handle_failed(now, &mut plc),
            2 => now += Duration::from_millis(100 * u64::from(len)),
            3 => {
                let read = Command::fetch(Area::db(5, len), 140).expect("a data block");
                jobs += u32::from(endpoint.submit(read, &[]).is_ok());
            }
            4 => drop(endpoint.poll_transmit(now)),
            5 => endpoint.cancel(now),
            6 => {
                if let Ok(write) = Command::send(Area::dx(len, 0), u16::from(len) / 2) {
                    jobs += u32::from(endpoint.submit(write, block).is_ok());
                }
            }
            _ => endpoint.handle_block(now, block, &mut plc),
        }
        endpoint.handle_timeout(now, &mut plc);
        assert!(endpoint.poll_timeout().is_none_or(|due| due > now));
        outcomes += ended(&mut endpoint);
        assert!(jobs - outcomes <= 1);
    }
    // Silence on a line that delivers: everything comes to rest.
    for _ in 0..4 {
        let _ = endpoint.poll_transmit(now);
        endpoint.handle_delivered(now);
        now += Duration::from_secs(30);
        endpoint.handle_timeout(now, &mut plc);
        outcomes += ended(&mut endpoint);
    }
    assert_eq!(jobs, outcomes);
    assert_eq!(endpoint.poll_timeout(), None);
});

/// Own jobs that have ended since the last call.
fn ended(endpoint: &mut Endpoint<300>) -> u32 {
    let mut count = 0;
    while let Some(event) = endpoint.poll_event() {
        count += u32::from(matches!(event, Event::Own(_)));
    }
    count
}
