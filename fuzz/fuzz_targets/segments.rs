//! Any bytes as segments of steps: what decodes goes forwards, encodes to its bytes, and is played
//! as long as it says.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pvt_steps::{Segment, SegmentPlayer};

fuzz_target!(|data: &[u8]| {
    let (mut bytes, mut player) = (data, SegmentPlayer::new());
    while let Ok((segment, rest)) = Segment::decode(bytes) {
        let mut buffer = [0; Segment::MAX_ENCODED_LEN];
        let encoded = segment.encode(&mut buffer);
        assert_eq!(encoded, &bytes[..bytes.len() - rest.len()]);
        assert_eq!(player.load(&segment), segment.delay_ticks());
        assert_eq!(player.len() + 1, usize::from(segment.count()));
        let mut span = 0_u64;
        for interval in player.by_ref() {
            assert!(interval > 0);
            span += u64::from(interval);
        }
        assert_eq!(span, u64::from(segment.span_ticks()));
        bytes = rest;
    }
});
