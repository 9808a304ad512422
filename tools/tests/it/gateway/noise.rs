//! Lines that are damaged on the way.

use proto3964r::tokio::Link;
use tokio::{
    io::{AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _, duplex, split},
    net::TcpStream,
};

use super::partner::PARTNER;

/// What happens to the characters of both directions: to one in so many each; 0 for never.
#[derive(Clone, Copy, Default)]
pub(crate) struct Noise {
    /// One bit is another one.
    pub(crate) flipped: u32,
    pub(crate) lost: u32,
    /// The connection ends.
    pub(crate) cut: u32,
}

/// Xorshift of 32 bits.
pub(crate) struct Random(pub(crate) u32);

impl Random {
    pub(crate) const fn draw(&mut self) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0
    }

    /// Whether it is the one in so many.
    const fn is_one_in(&mut self, many: u32) -> bool {
        many != 0 && self.draw().is_multiple_of(many)
    }
}

impl Noise {
    /// A partner behind such a line.
    pub(crate) fn link(self, stream: TcpStream, seed: u32) -> Link {
        let (here, there) = duplex(4096);
        let (from_gateway, to_gateway) = stream.into_split();
        let (from_partner, to_partner) = split(there);
        tokio::spawn(async move {
            // When one direction is cut, so is the other.
            tokio::select! {
                () = self.carry(from_gateway, to_partner, Random(seed)) => {}
                () = self.carry(from_partner, to_gateway, Random(seed ^ 0x5555_5555)) => {}
            }
        });
        Link::new(here, PARTNER)
    }

    async fn carry(
        self,
        mut from: impl AsyncRead + Unpin,
        mut to: impl AsyncWrite + Unpin,
        mut random: Random,
    ) {
        let mut piece = [0; 256];
        while let Ok(len @ 1..) = from.read(&mut piece).await {
            let mut kept = Vec::with_capacity(len);
            for &byte in &piece[..len] {
                if random.is_one_in(self.cut) {
                    return;
                }
                if random.is_one_in(self.lost) {
                    continue;
                }
                let is_flipped = random.is_one_in(self.flipped);
                kept.push(byte ^ u8::from(is_flipped) << (random.0 >> 29));
            }
            if to.write_all(&kept).await.is_err() {
                return;
            }
        }
    }
}
