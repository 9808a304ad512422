//! A block of the partner, which is heard and refused.

use core::time::Duration;

use proto3964r::{
    ascii::{DLE, ETX, NAK},
    frame::Check,
};

use super::{Bench, Heard, ParityFound, Probe, SILENCE};
use crate::{Frame, Parity};

/// From the end of a block to a BCC, besides the time of the character: a pause of an adapter.
const BCC_WAIT: Duration = Duration::from_millis(100);

/// What was heard of a block.
struct Block {
    len: usize,
    check: Option<Check>,
    is_clean: bool,
}

impl<B: Bench> Probe<'_, B> {
    /// Answers DLE to the STX that has just come, hears the block and refuses it. ETX has an even
    /// number of ones: with it a parity bit shows.
    pub(super) async fn receive(&mut self) -> Result<(), B::Error> {
        self.bench.send(DLE).await?;
        let block = self.block().await?;
        self.bench.send(NAK).await?;
        let Some((baud, parity)) = self.findings.frame else {
            return Ok(());
        };
        let is_open = parity == ParityFound::EvenOrNone;
        if block.is_clean {
            self.findings.check = block.check;
            self.findings.longest = self.findings.longest.max(Some(block.len));
            if is_open && self.bench.tells_damage() {
                self.findings.frame = Some((baud, self.parity.into()));
            }
        } else if is_open {
            // Damaged, or made with the other parity: the next one tells.
            let parity = match self.parity {
                Parity::None => Parity::Even,
                Parity::Even | Parity::Odd => Parity::None,
            };
            let stop_bits = 1;
            let frame = Frame {
                baud,
                parity,
                stop_bits,
            };
            self.set(frame).await?;
        }
        Ok(())
    }

    async fn block(&mut self) -> Result<Block, B::Error> {
        let mut block = Block {
            len: 0,
            check: None,
            is_clean: true,
        };
        let (mut bcc, mut is_after_dle) = (0, false);
        loop {
            let until = self.bench.now() + SILENCE;
            let Some(Heard { byte, .. }) = self.hear(until).await? else {
                block.is_clean = false;
                return Ok(block);
            };
            let Some(byte) = byte else {
                block.is_clean = false;
                self.rest().await?;
                return Ok(block);
            };
            bcc ^= byte;
            match (is_after_dle, byte) {
                (false, DLE) => is_after_dle = true,
                (true, ETX) => break,
                (true, DLE) | (false, _) => {
                    block.len += 1;
                    is_after_dle = false;
                }
                (true, _) => {
                    block.is_clean = false;
                    self.rest().await?;
                    return Ok(block);
                }
            }
        }
        let until = self.bench.now() + BCC_WAIT + self.character * 2;
        block.check = match self.hear(until).await? {
            None => Some(Check::None),
            Some(Heard {
                byte: Some(byte), ..
            }) if byte == bcc => Some(Check::Bcc),
            Some(_) => {
                block.is_clean = false;
                None
            }
        };
        Ok(block)
    }
}
