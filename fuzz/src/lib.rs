//! Settings and cuts that the fuzzer chooses, for more than one target.

use arbitrary::{Arbitrary, Result, Unstructured};
use pattern_codec::engraving::{AxisCodes, ByteOrder, Format, Mode, PerAxis};
use proto3964r::{
    Check, Collision, Config, IdleNoise, IllegalDle, LineError, Priority, SilenceInBlock,
};

/// The pieces of a slice: lengths over and over, at least one byte each.
#[derive(Debug, Arbitrary)]
pub struct Cuts([u8; 4]);

impl Cuts {
    pub fn of<'a>(&self, mut bytes: &'a [u8]) -> impl Iterator<Item = &'a [u8]> {
        let mut lengths = self.0.into_iter().cycle();
        std::iter::from_fn(move || {
            let wanted = usize::from(lengths.next()?).max(1);
            let (piece, rest) = bytes.split_at(wanted.min(bytes.len()));
            bytes = rest;
            (!piece.is_empty()).then_some(piece)
        })
    }
}

/// Any format: one of the 24 orders of the axis codes, byte order, mode.
pub fn format(u: &mut Unstructured<'_>) -> Result<Format> {
    let mut left = vec![0, 1, 2, 3];
    let mut code = || -> Result<u8> { Ok(left.swap_remove(u.choose_index(left.len())?)) };
    let codes = PerAxis {
        theta1: code()?,
        theta2: code()?,
        theta3: code()?,
        vertical: code()?,
    };
    Ok(Format::default()
        .with_axis_codes(AxisCodes::new(codes).expect("codes are distinct"))
        .with_byte_order(*u.choose(&[ByteOrder::BigEndian, ByteOrder::LittleEndian])?)
        .with_mode(*u.choose(&[Mode::Strict, Mode::Lenient])?))
}

pub fn check(u: &mut Unstructured<'_>) -> Result<Check> {
    u.choose(&[Check::Bcc, Check::None]).copied()
}

pub fn illegal_dle(u: &mut Unstructured<'_>) -> Result<IllegalDle> {
    let rules = [
        IllegalDle::RejectAtEnd,
        IllegalDle::RejectAtOnce,
        IllegalDle::Accept,
    ];
    u.choose(&rules).copied()
}

pub fn line_error(u: &mut Unstructured<'_>) -> Result<LineError> {
    let errors = [LineError::Parity, LineError::Framing, LineError::Overrun];
    u.choose(&errors).copied()
}

/// Any station's settings, times from `least_ms` on, at most 7 attempts of a kind.
pub fn config(u: &mut Unstructured<'_>, least_ms: u16) -> Result<Config> {
    let mut ms = |most: u16| u.int_in_range(least_ms..=most);
    let config = Config::siemens_3964r(Priority::Low)
        .with_qvz_ms(ms(3000)?)
        .with_zvz_ms(ms(500)?)
        .with_bwz_ms(ms(5000)?)
        .with_buffer_wait_ms(ms(1000)?);
    let collisions = [Collision::Wait, Collision::YieldOnRetry, Collision::Repeat];
    let noises = [
        IdleNoise::NakAfterSilence,
        IdleNoise::NakAtOnce,
        IdleNoise::Ignore,
    ];
    let silences = [SilenceInBlock::Idle, SilenceInBlock::ExpectRepeat];
    Ok(config
        .with_babble_s(u.int_in_range(1..=10)?)
        .with_setup_attempts(u.int_in_range(0..=7)?)
        .with_transfer_attempts(u.int_in_range(0..=7)?)
        .with_priority(*u.choose(&[Priority::Low, Priority::High])?)
        .with_check(check(u)?)
        .with_collision(*u.choose(&collisions)?)
        .with_idle_noise(*u.choose(&noises)?)
        .with_illegal_dle(illegal_dle(u)?)
        .with_silence_in_block(*u.choose(&silences)?)
        .with_allow_empty(u.arbitrary()?)
        .with_nak_at_startup(u.arbitrary()?)
        .with_ignore_early_answers(u.arbitrary()?))
}
