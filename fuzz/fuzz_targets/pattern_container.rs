//! Any bytes as a container, and containers with damage: slice and stream agree, damage is found.
#![no_main]

use arbitrary::{Result, Unstructured};
use libfuzzer_sys::fuzz_target;
use pattern_codec::container::{
    Container, ContainerError, Content, Header, Verifier, Writer, open,
};
use pose2pulse_fuzz::Cuts;

fuzz_target!(|data: &[u8]| {
    let mut u = Unstructured::new(data);
    if u.arbitrary().unwrap_or(false) {
        let Ok(cuts) = u.arbitrary() else { return };
        let _ = opened(u.take_rest(), &cuts);
    } else {
        let _ = written(u);
    }
});

/// What `open` says, after the stream has said the same.
fn opened<'a>(bytes: &'a [u8], cuts: &Cuts) -> std::result::Result<Container<'a>, ContainerError> {
    let mut verifier = Verifier::new();
    let mut refused = None;
    for piece in cuts.of(bytes) {
        let now = verifier.update(piece).err();
        // An error is final.
        assert!(refused.is_none() || now == refused);
        refused = now;
    }
    let streamed = verifier.finish();
    if let Some(error) = refused {
        assert_eq!(streamed, Err(error));
    }
    let container = open(bytes);
    assert_eq!(container.map(|container| container.header()), streamed);
    if let Ok(container) = &container {
        let Content::Engraving(format) = container.header().content() else {
            panic!("a content that nobody wrote");
        };
        let records = container.payload().len() as u64 / 3;
        let header = Header::engraving(&format, records).expect("it was opened");
        assert_eq!(bytes, file(header, container.payload()));
    }
    container
}

fn file(header: Header, payload: &[u8]) -> Vec<u8> {
    let (head, mut writer) = Writer::new(header);
    writer.update(payload).expect("as long as the header says");
    let trailer = writer.finish().expect("as long as the header says");
    [&head, payload, &trailer].concat()
}

/// A container opens as it was written, and not with one or two wrong bits, cut short or extended.
fn written(mut u: Unstructured<'_>) -> Result<()> {
    let format = pose2pulse_fuzz::format(&mut u)?;
    let (cuts, flips): (Cuts, [u32; 2]) = u.arbitrary()?;
    let (cut, tail): (u16, [u8; 2]) = u.arbitrary()?;
    let rest = u.take_rest();
    let payload = &rest[..rest.len() / 3 * 3];
    let records = payload.len() as u64 / 3;
    let header = Header::engraving(&format, records).expect("a short payload");
    let file = file(header, payload);
    let container = opened(&file, &cuts).expect("it is whole");
    assert_eq!((container.header(), container.payload()), (header, payload));

    let mut damaged = file.clone();
    for flip in flips {
        let place = flip as usize % (8 * file.len());
        damaged[place / 8] ^= 1 << (place % 8);
        assert!(damaged == file || opened(&damaged, &cuts).is_err());
    }
    assert!(opened(&file[..usize::from(cut) % file.len()], &cuts).is_err());
    assert!(opened(&[&file, tail.as_slice()].concat(), &cuts).is_err());
    Ok(())
}
