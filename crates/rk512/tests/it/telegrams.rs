//! Headers, error numbers and the checks of decoding, by name and value.

use core::time::Duration;

use rk512::{
    Area, AreaKind, Client, Command, CommandError, Config, Continuation, CoordinationError,
    EncodeError, Endpoint, Message, Reaction, ReactionError, ReactionFault, Request, RequestError,
    Server,
};

const SEND_DB5: [u8; 12] = [0, 0, 0x41, 0x44, 5, 10, 0, 1, 0xFF, 0xFF, 0x12, 0x34];
const FETCH_DB5: [u8; 10] = [0, 0, 0x45, 0x44, 5, 0, 0, 1, 0xFF, 0xFF];

/// What decoding says when one byte of a good command is replaced.
fn with_byte(good: &[u8], number: usize, value: u8) -> Result<Command, CommandError> {
    let mut block = good.to_vec();
    block[number - 1] = value;
    Command::decode(&block).map(|(command, _)| command)
}

#[test]
fn memory_is_as_stated() {
    assert!(size_of::<Client<256>>() <= 256 + 144);
    assert!(size_of::<Server>() <= 288);
    assert!(size_of::<Endpoint<256>>() <= size_of::<Client<256>>() + size_of::<Server>() + 8);
}

#[test]
fn area_codes_and_units_are_those_of_the_manuals() {
    let table = [
        (AreaKind::DataBlock, 0x44, 2),
        (AreaKind::ExtendedDataBlock, 0x58, 2),
        (AreaKind::Inputs, 0x45, 1),
        (AreaKind::Outputs, 0x41, 1),
        (AreaKind::Flags, 0x4D, 1),
        (AreaKind::Timers, 0x54, 2),
        (AreaKind::Counters, 0x5A, 2),
        (AreaKind::Peripheral, 0x50, 1),
        (AreaKind::Absolute, 0x53, 2),
        (AreaKind::System, 0x42, 2),
    ];
    for (kind, code, unit) in table {
        assert_eq!((kind.code(), kind.bytes_per_unit()), (code, unit), "{kind}");
        assert_eq!(AreaKind::from_code(code), Some(kind));
    }
    // The letters of a translated manual name no area.
    for letter in [b'I', b'C'] {
        assert_eq!(AreaKind::from_code(letter), None);
    }
}

#[test]
fn every_error_number_keeps_its_value() {
    assert_eq!(ReactionError::from_code(0), None);
    for code in 1..=u8::MAX {
        assert_eq!(ReactionError::from_code(code).map(|e| e.code()), Some(code));
    }
    let named = (1..=u8::MAX)
        .filter_map(ReactionError::from_code)
        .filter(|error| !matches!(error, ReactionError::Other(_)));
    assert_eq!(
        named.map(ReactionError::code).collect::<Vec<_>>(),
        [
            0x0A, 0x0C, 0x10, 0x12, 0x14, 0x16, 0x2A, 0x32, 0x34, 0x36, 0xFE, 0xFF
        ]
    );
}

#[test]
fn commands_that_cannot_be_made() {
    let kind = AreaKind::Flags;
    let not_sendable = Err(RequestError::NotSendable { kind });
    assert_eq!(Command::send(Area::flags(0), 1), not_sendable);
    assert_eq!(Command::send(Area::db(1, 0), 0), Err(RequestError::Empty));
    assert_eq!(Command::fetch(Area::flags(0), 0), Err(RequestError::Empty));
    assert!(Area::new(AreaKind::Inputs, 1, 0).is_err());
    let command = Command::send(Area::db(1, 0), 65).unwrap();
    let (len, expected) = (130, 128);
    let error = EncodeError::DataLength { len, expected };
    assert_eq!(command.telegram(&[0; 130]), Err(error));
    let error = EncodeError::TooMuchData { len: 129 };
    let continuation = Continuation::new(Request::SendDb);
    assert_eq!(continuation.telegram(&[0; 129]), Err(error));
}

/// Every check of a command that needs no history: the error, its reaction, its event.
#[test]
fn every_check_of_a_command_has_its_reaction_and_event() {
    use CommandError as E;
    let kind = AreaKind::Outputs;
    let bit = CoordinationError::Flag { byte: 1, bit: 8 };
    let nibble = CoordinationError::Cpu { nibble: 9 };
    let flag_5 = [0, 0, 0x45, 0x4D, 0, 20, 0, 4, 5, 0x01];
    let first_byte = E::FirstByte { value: 0x55 };
    let short = E::TooShort { len: 9, least: 10 };
    let long = E::FirstDataLength {
        len: 3,
        expected: 2,
    };
    let area = Area::new(AreaKind::Flags, 7, 20).unwrap_err();
    let mut fetch_with_data = FETCH_DB5.to_vec();
    fetch_with_data.push(0);
    let mut send_with_more = SEND_DB5.to_vec();
    send_with_more.push(0);
    let decode = |block: &[u8]| Command::decode(block).map(|(command, _)| command);
    #[rustfmt::skip]
    let table = [
        (with_byte(&SEND_DB5, 1, 0x55), first_byte, 0x10, None),
        (with_byte(&SEND_DB5, 2, 1), E::SecondByte { value: 1 }, 0x10, None),
        (with_byte(&SEND_DB5, 3, 0x42), E::Request { value: 0x42 }, 0x16, None),
        (with_byte(&SEND_DB5, 4, 0x49), E::AreaKind { value: 0x49 }, 0x10, None),
        (with_byte(&SEND_DB5, 4, 0x41), E::SendSource { kind }, 0x0C, None),
        (with_byte(&FETCH_DB5, 4, 0x49), E::AreaKind { value: 0x49 }, 0x10, None),
        (with_byte(&flag_5, 5, 7), E::Number(area), 0x14, Some(0x0606)),
        (with_byte(&SEND_DB5, 8, 0), E::Length { value: 0 }, 0x34, Some(0x0608)),
        (with_byte(&[0, 0, 0x45, 0x4D, 0, 0, 0, 4, 1, 1], 10, 8), E::Coordination(bit), 0x0A, Some(0x0609)),
        (with_byte(&flag_5, 10, 0x91), E::Coordination(nibble), 0x0A, Some(0x060A)),
        (decode(&send_with_more), long, 0x34, Some(0x0611)),
        (decode(&fetch_with_data), E::FetchWithData { len: 1 }, 0x34, Some(0x060C)),
        (decode(&SEND_DB5[..9]), short, 0x34, Some(0x0610)),
    ];
    for (got, error, reaction, event) in table {
        assert_eq!(got, Err(error));
        assert_eq!(error.reaction().code(), reaction, "{error}");
        assert_eq!(error.event(), event, "{error}");
    }
}

#[test]
fn every_check_of_a_continuation() {
    use CommandError as E;
    let (len, expected) = (129, 128);
    let long = [&[0xFF, 0, 0x41, 0x44][..], &[0; 129]].concat();
    for (block, error) in [
        (&[0xFF, 0, 0x41][..], E::TooShort { len: 3, least: 4 }),
        (&[0, 0, 0x41, 0x44], E::FirstByte { value: 0 }),
        (&[0xFF, 0, 0x45, 0x44, 9], E::FetchWithData { len: 1 }),
        (&long, E::ContinuationDataLength { len, expected }),
    ] {
        let refused = Continuation::decode(block).map(|(header, _)| header);
        assert_eq!(refused, Err(error));
    }
}

#[test]
fn every_check_of_a_reaction_header() {
    use ReactionFault as F;
    let (len, expected) = (129, 128);
    for (block, fault, event) in [
        (&[0, 0, 0][..], F::TooShort { len: 3 }, 0x0A06),
        (&[0x7F, 0, 0, 0], F::FirstByte { value: 0x7F }, 0x0A02),
        (&[0; 133], F::DataLength { len, expected }, 0x0A03),
    ] {
        let refused = Reaction::decode(block).map(|(header, _)| header);
        assert_eq!((refused, fault.event()), (Err(fault), Some(event)));
    }
    for (block, byte, value) in [([0, 1, 0, 0], 2, 1), ([0, 0, 2, 0], 3, 2)] {
        let refused = Reaction::decode(&block).map(|(header, _)| header);
        assert_eq!(refused, Err(ReactionFault::NotZero { byte, value }));
    }
}

#[test]
fn errors_name_byte_and_value() {
    let error = with_byte(&SEND_DB5, 3, 0x42).unwrap_err();
    assert_eq!(error.to_string(), "byte 3: 42h, neither 41h, 4Fh nor 45h");
    let error = Message::decode(&[0, 0, 0]).unwrap_err();
    let short = "reaction: 3 bytes, the header alone has 4";
    assert_eq!(error.to_string(), short);
    let error = ReactionError::from_code(0x77).unwrap();
    assert_eq!(error.to_string(), "unknown error number 77h");
}

#[test]
fn reaction_time_by_baud_rate() {
    let seconds = |baud| Config::reaction_time_for(baud).as_secs();
    let rates = [110, 300, 600, 1200, 2400, 9600, 19_200, 38_400, 115_200];
    assert_eq!(rates.map(seconds), [20, 10, 7, 5, 5, 5, 5, 3, 3]);
    assert_eq!(Config::default().reaction_time, Duration::from_secs(20));
}

#[test]
fn the_end_of_time_is_late_enough() {
    let mut client = Client::<4>::new(Config::DEFAULT);
    client
        .submit(Command::fetch(Area::db(1, 0), 1).unwrap(), &[])
        .unwrap();
    assert!(client.poll_transmit(Duration::MAX).is_some());
    client.handle_delivered(Duration::MAX);
    assert_eq!(client.poll_timeout(), Some(Duration::MAX));
}

#[cfg(feature = "serde")]
#[test]
fn serde_keeps_commands_and_refuses_wrong_ones() {
    use test_support::{not_read, stored};
    let command = Command::send(Area::db(5, 10), 65).unwrap();
    assert_eq!(stored(&command), "[0,0,65,68,5,10,0,65,255,255]");
    let _reason = not_read::<Command>("[0,0,65,68,5,10,0,0,255,255]");
    stored(&Area::flags(20));
    let _reason = not_read::<Area>(r#"["Flags",1,20]"#);
    stored(&Config::DEFAULT);
}
