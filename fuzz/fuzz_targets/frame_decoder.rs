//! Any characters as 3964 and 3964R blocks: pieces of any size agree, accepted blocks are those
//! that encoding writes, and encoding is undone by decoding.
#![no_main]

use arbitrary::{Result, Unstructured};
use libfuzzer_sys::fuzz_target;
use pose2pulse_fuzz::Cuts;
use proto3964r::frame::{
    Check, Decoder, EncodeError, FrameError, IllegalDle, decode, encode, max_encoded_len,
};

fuzz_target!(|data: &[u8]| {
    let _ = run(Unstructured::new(data));
});

/// The end of a block: how many characters were taken up to then, the payload or its fault.
type Block = (usize, std::result::Result<Vec<u8>, FrameError>);

fn run(mut u: Unstructured<'_>) -> Result<()> {
    let check = pose2pulse_fuzz::check(&mut u)?;
    let rule = pose2pulse_fuzz::illegal_dle(&mut u)?;
    let cuts: Cuts = u.arbitrary()?;
    let capacity = usize::from(u.arbitrary::<u8>()?);
    let bytes = u.take_rest();
    let decoder = Decoder::new(check).with_illegal_dle(rule);

    let blocks = by_byte(decoder.clone(), bytes, capacity);
    assert_eq!(blocks, by_piece(decoder, bytes, &cuts, capacity));
    let mut start = 0;
    for (end, block) in &blocks {
        if let Ok(payload) = block
            && rule != IllegalDle::Accept
        {
            assert_eq!(bytes[start..*end], body(payload, check));
        }
        start = *end;
    }
    round_trip(bytes, check);
    Ok(())
}

fn by_byte(mut decoder: Decoder, bytes: &[u8], capacity: usize) -> Vec<Block> {
    let mut buffer = vec![0; capacity];
    let mut blocks = Vec::new();
    for (index, &byte) in bytes.iter().enumerate() {
        if let Some(block) = decoder.push(byte, &mut buffer) {
            blocks.push((index + 1, block.map(|len| buffer[..len].to_vec())));
        }
    }
    blocks
}

fn by_piece(mut decoder: Decoder, bytes: &[u8], cuts: &Cuts, capacity: usize) -> Vec<Block> {
    let mut buffer = vec![0; capacity];
    let mut blocks = Vec::new();
    let mut taken = 0;
    for mut piece in cuts.of(bytes) {
        while !piece.is_empty() {
            let (count, block) = decoder.feed(piece, &mut buffer);
            taken += count;
            piece = &piece[count..];
            assert!(block.is_some() || piece.is_empty());
            if let Some(block) = block {
                blocks.push((taken, block.map(|len| buffer[..len].to_vec())));
            }
        }
    }
    blocks
}

fn body(payload: &[u8], check: Check) -> Vec<u8> {
    let mut body = vec![0; max_encoded_len(payload.len())];
    let len = encode(payload, check, &mut body).expect("the buffer is long enough");
    body.truncate(len);
    body
}

fn round_trip(payload: &[u8], check: Check) {
    let body = body(payload, check);
    assert!(check == Check::None || body.iter().fold(0, |xor, byte| xor ^ byte) == 0);
    let mut short = vec![0; body.len() - 1];
    let refused = encode(payload, check, &mut short);
    let (needed, available) = (body.len(), short.len());
    assert_eq!(
        refused,
        Err(EncodeError::BufferTooSmall { needed, available })
    );
    let mut buffer = vec![0; payload.len()];
    assert_eq!(decode(&body, check, &mut buffer), Ok((payload, &[][..])));
}
