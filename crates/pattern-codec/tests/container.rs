//! Containers: known bytes, every single flipped bit, every truncation, any chunking.

#[cfg(test)]
mod container {
    use pattern_codec::container::{
        Container, ContainerError, Content, HEADER_LEN, Header, HeaderError, TRAILER_LEN, Verifier,
        Writer, open,
    };
    use pattern_codec::engraving::{AxisCodes, ByteOrder, Format, Mode, PerAxis};
    use proptest::prelude::*;

    const PAYLOAD: [u8; 9] = [0xFF, 0x01, 0x90, 0x02, 0x0F, 0x9E, 0x7F, 0x01, 0x90];

    fn pack(format: &Format, payload: &[u8]) -> Vec<u8> {
        let header = Header::engraving(format, payload.len() as u64 / 3).unwrap();
        let (bytes, mut writer) = Writer::new(header);
        let mut container = bytes.to_vec();
        for piece in payload.chunks(4) {
            writer.update(piece).unwrap();
            container.extend(piece);
        }
        container.extend(writer.finish().unwrap());
        container
    }

    fn verify(bytes: &[u8], chunk: usize) -> Result<Header, ContainerError> {
        let mut verifier = Verifier::new();
        for piece in bytes.chunks(chunk) {
            verifier.update(piece)?;
        }
        verifier.finish()
    }

    /// Bit by bit, apart from the table that is tested.
    fn crc_32(bytes: &[u8]) -> [u8; 4] {
        let mut crc = u32::MAX;
        for byte in bytes {
            crc ^= u32::from(*byte);
            for _ in 0..8 {
                let shifted = crc >> 1;
                crc = if crc & 1 == 1 {
                    shifted ^ 0xEDB8_8320
                } else {
                    shifted
                };
            }
        }
        (!crc).to_be_bytes()
    }

    /// Any fields and payload with right check values, to reach what stands behind them.
    fn sealed(fields: [u8; 12], payload: &[u8]) -> Vec<u8> {
        let body = [&fields[..], payload].concat();
        [&fields[..], &crc_32(&fields), payload, &crc_32(&body)].concat()
    }

    fn header_error(fields: [u8; 12]) -> HeaderError {
        match open(&sealed(fields, &[])) {
            Err(ContainerError::Header(error)) => error,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_bytes_are_those_of_another_crc_32() {
        // Check values by Python's zlib.crc32.
        let expected = [
            0x89, 0x50, 0x32, 0x50, 1, 1, 0xE4, 0, 0, 0, 0, 3, 0x9E, 0x50, 0x5E, 0x4D, 0x02, 0x0F,
            0x9E, 0x5B, 0xFB, 0x90, 0xD3,
        ];
        assert_eq!(pack(&Format::new(), &[0x02, 0x0F, 0x9E]), expected);
    }

    #[test]
    fn what_was_written_is_read() {
        let codes = PerAxis {
            theta1: 2,
            theta2: 3,
            theta3: 0,
            vertical: 1,
        };
        let format = Format::new()
            .with_axis_codes(AxisCodes::new(codes).unwrap())
            .with_byte_order(ByteOrder::LittleEndian);
        let bytes = pack(&format.with_mode(Mode::Lenient), &PAYLOAD);
        assert_eq!(bytes.len(), HEADER_LEN + PAYLOAD.len() + TRAILER_LEN);
        let container = open(&bytes).unwrap();
        assert_eq!(container.payload(), PAYLOAD);
        assert_eq!(container.header().payload_len(), 9);
        assert_eq!(container.header().content(), Content::Engraving(format));
    }

    #[test]
    fn an_empty_payload_is_a_whole_container() {
        let bytes = pack(&Format::new(), &[]);
        assert_eq!(
            open(&bytes).map(|container| container.payload().len()),
            Ok(0)
        );
    }

    #[test]
    fn every_flipped_bit_is_refused() {
        let bytes = pack(&Format::new(), &PAYLOAD);
        for place in 0..bytes.len() {
            for bit in 0..8 {
                let mut damaged = bytes.clone();
                damaged[place] ^= 1 << bit;
                let error = open(&damaged).unwrap_err();
                let as_expected = match error {
                    ContainerError::Header(HeaderError::Magic { .. }) => place < 4,
                    ContainerError::Header(HeaderError::Damaged { .. }) => {
                        (4..HEADER_LEN).contains(&place)
                    }
                    ContainerError::Damaged { .. } => place >= HEADER_LEN,
                    _ => false,
                };
                assert!(as_expected, "byte {place} bit {bit}: {error}");
            }
        }
    }

    #[test]
    fn every_truncation_is_refused_with_both_lengths() {
        let bytes = pack(&Format::new(), &PAYLOAD);
        for len in 0..bytes.len() {
            let expected = if len < HEADER_LEN {
                HEADER_LEN
            } else {
                bytes.len()
            };
            assert_eq!(
                open(&bytes[..len]),
                Err(ContainerError::Truncated {
                    expected: expected as u64,
                    found: len as u64
                })
            );
        }
    }

    #[test]
    fn bytes_behind_the_end_are_refused() {
        let mut bytes = pack(&Format::new(), &PAYLOAD);
        let expected = bytes.len() as u64;
        bytes.push(0);
        assert_eq!(
            open(&bytes),
            Err(ContainerError::TrailingBytes { expected })
        );
        // Also when they come later than the rest.
        assert_eq!(
            verify(&bytes, bytes.len() - 1),
            Err(ContainerError::TrailingBytes { expected })
        );
    }

    #[test]
    fn a_header_of_another_container_is_refused() {
        let mine = pack(&Format::new(), &PAYLOAD);
        let little = Format::new().with_byte_order(ByteOrder::LittleEndian);
        let theirs = pack(&little, &PAYLOAD);
        let mixed = [&theirs[..HEADER_LEN], &mine[HEADER_LEN..]].concat();
        assert!(matches!(open(&mixed), Err(ContainerError::Damaged { .. })));
    }

    #[test]
    fn a_header_with_a_wrong_value_is_refused_by_name() {
        let good = [0x89, 0x50, 0x32, 0x50, 1, 1, 0xE4, 0, 0, 0, 0, 3];
        let with = |place: usize, value| {
            let mut fields = good;
            fields[place] = value;
            header_error(fields)
        };
        assert_eq!(with(4, 2), HeaderError::Version { found: 2 });
        assert_eq!(with(5, 7), HeaderError::Content { found: 7 });
        assert_eq!(
            with(6, 0x24).to_string(),
            "header byte 6: theta1 and vertical: both have the axis code 0"
        );
        assert_eq!(with(7, 2), HeaderError::ByteOrder { found: 2 });
        assert_eq!(with(11, 4), HeaderError::PartialRecord { payload_len: 4 });
        let zip = open(b"PK\x03\x04 and then many more bytes").unwrap_err();
        assert_eq!(
            zip.to_string(),
            "no container: it starts with [50, 4B, 03, 04], not with [89, 50, 32, 50]"
        );
    }

    #[test]
    fn a_payload_of_another_length_cannot_be_finished() {
        let header = Header::engraving(&Format::new(), 1).unwrap();
        let (_, mut writer) = Writer::new(header);
        writer.update(&[1, 2]).unwrap();
        let error = writer.clone().finish().unwrap_err();
        assert_eq!((error.declared, error.written), (3, 2));
        let error = writer.update(&[3, 4]).unwrap_err();
        assert_eq!(
            error.to_string(),
            "4 bytes of payload written, the header says 3"
        );
        assert_eq!(writer.finish(), Err(error));
    }

    #[test]
    fn more_records_than_the_length_can_count_are_refused() {
        let most = u64::from(u32::MAX) / 3;
        assert_eq!(
            Header::engraving(&Format::new(), most)
                .unwrap()
                .payload_len(),
            u32::MAX
        );
        let error = Header::engraving(&Format::new(), most + 1).unwrap_err();
        assert_eq!(
            error.to_string(),
            "1431655766 records are more than the 1431655765 of one container"
        );
    }

    #[test]
    fn an_error_is_final() {
        let mut bytes = pack(&Format::new(), &PAYLOAD);
        bytes[13] ^= 4;
        let mut verifier = Verifier::new();
        let error = verifier.update(&bytes[..HEADER_LEN]).unwrap_err();
        assert_eq!(verifier.update(&bytes[HEADER_LEN..]), Err(error));
        assert_eq!(verifier.finish(), Err(error));
    }

    proptest! {
        #[test]
        fn any_chunking_gives_the_same_answer(
            payload in prop::collection::vec(any::<[u8; 3]>(), 0..40),
            chunk in 1_usize..50,
            flip in prop::option::of(any::<(prop::sample::Index, u8)>()),
        ) {
            let mut bytes = pack(&Format::new(), payload.as_flattened());
            if let Some((place, mask)) = flip {
                let place = place.index(bytes.len());
                bytes[place] ^= mask;
                prop_assert_eq!(open(&bytes).is_err(), mask != 0);
            }
            prop_assert_eq!(
                verify(&bytes, chunk),
                open(&bytes).as_ref().map(Container::header).map_err(|error| *error)
            );
        }

        #[test]
        fn arbitrary_bytes_are_refused(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            prop_assert!(open(&bytes).is_err());
        }

        #[test]
        fn a_sealed_container_is_accepted_when_every_field_is_right(
            version in 0_u8..3,
            content in 0_u8..3,
            axes in prop_oneof![Just(0xE4), Just(0x1B), any::<u8>()],
            order in 0_u8..3,
            len in 0_u32..8,
            payload in prop::collection::vec(any::<u8>(), 0..8),
        ) {
            let mut fields = [0x89, 0x50, 0x32, 0x50, version, content, axes, order, 0, 0, 0, 0];
            fields[8..].copy_from_slice(&len.to_be_bytes());
            let bytes = sealed(fields, &payload);
            let codes = [axes & 3, axes >> 2 & 3, axes >> 4 & 3, axes >> 6];
            let distinct = (0..4).all(|code| codes.contains(&code));
            let right = version == 1
                && content == 1
                && distinct
                && order < 2
                && len % 3 == 0
                && len as usize == payload.len();
            prop_assert_eq!(open(&bytes).is_ok(), right);
            if let Ok(container) = open(&bytes) {
                let Content::Engraving(format) = container.header().content() else {
                    panic!("an unknown content was accepted")
                };
                prop_assert_eq!(pack(&format, container.payload()), bytes);
            }
        }
    }
}
