//! Settings and cuts that the fuzzer chooses, for more than one target.

use arbitrary::{Arbitrary, Result, Unstructured};
use pattern_codec::engraving::{AxisCodes, ByteOrder, Format, PerAxis, Strictness};
use proto3964r::{
    CharacterError, Check, Config, Conflict, IdleNoise, IllegalDle, Line, Priority, SilenceInBlock,
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

/// Any format: one of the 24 orders of the axis codes, byte order, strictness.
pub fn format(u: &mut Unstructured<'_>) -> Result<Format> {
    let mut left = vec![0, 1, 2, 3];
    let mut code = || -> Result<u8> { Ok(left.swap_remove(u.choose_index(left.len())?)) };
    let codes = PerAxis {
        elbow: code()?,
        shoulder: code()?,
        disc: code()?,
        vertical: code()?,
    };
    Ok(Format::default()
        .with_axis_codes(AxisCodes::new(codes).expect("codes are distinct"))
        .with_byte_order(*u.choose(&[ByteOrder::BigEndian, ByteOrder::LittleEndian])?)
        .with_strictness(*u.choose(&[Strictness::Strict, Strictness::Lenient])?))
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

pub fn line_error(u: &mut Unstructured<'_>) -> Result<CharacterError> {
    let errors = [
        CharacterError::Parity,
        CharacterError::Framing,
        CharacterError::Overrun,
    ];
    u.choose(&errors).copied()
}

/// Any line, of which a character takes up to 5 ms.
fn line(u: &mut Unstructured<'_>) -> Result<Line> {
    let character_ns = u.int_in_range(0..=5_000_000)?;
    let paced = Line::Paced { character_ns };
    let lines = [Line::Instant, paced, Line::Buffered { character_ns }];
    u.choose(&lines).copied()
}

/// Any station's settings, times from `least_ms` on, at most 7 attempts of a kind.
pub fn config(u: &mut Unstructured<'_>, least_ms: u16) -> Result<Config> {
    let conflicts = [Conflict::Wait, Conflict::YieldOnRetry, Conflict::Repeat];
    let noises = [
        IdleNoise::NakAfterSilence,
        IdleNoise::NakAtOnce,
        IdleNoise::Ignore,
    ];
    let silences = [SilenceInBlock::Idle, SilenceInBlock::ExpectRepeat];
    Ok(Config {
        qvz_ms: u.int_in_range(least_ms..=3000)?,
        zvz_ms: u.int_in_range(least_ms..=500)?,
        bwz_ms: u.int_in_range(least_ms..=5000)?,
        buffer_wait_ms: u.int_in_range(least_ms..=1000)?,
        acknowledge_wait_ms: u.int_in_range(0..=1000)? * u16::from(u.arbitrary::<bool>()?),
        line: line(u)?,
        max_noise_s: u.int_in_range(1..=10)?,
        connection_attempts: u.int_in_range(0..=7)?,
        transmission_attempts: u.int_in_range(0..=7)?,
        priority: *u.choose(&[Priority::Low, Priority::High])?,
        check: check(u)?,
        conflict: *u.choose(&conflicts)?,
        idle_noise: *u.choose(&noises)?,
        illegal_dle: illegal_dle(u)?,
        silence_in_block: *u.choose(&silences)?,
        allow_empty: u.arbitrary()?,
        nak_at_startup: u.arbitrary()?,
    })
}
