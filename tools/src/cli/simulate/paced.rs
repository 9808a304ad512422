//! A serial server's wire: characters take their time.

use core::time::Duration;

use tokio::{
    io::{
        AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _, DuplexStream, duplex, split,
    },
    time::{Instant, sleep_until},
};

use crate::{Frame, Port};

/// Characters that wait for the wire.
const QUEUE: usize = 4096;

/// The port, at the end of a wire in both directions.
pub(super) fn paced(port: Port, frame: Frame) -> DuplexStream {
    let character = Duration::from_secs(1) * u32::from(frame.bits()) / frame.baud;
    let (here, there) = duplex(QUEUE);
    let (from_port, to_port) = split(port);
    let (from_station, to_station) = split(there);
    tokio::spawn(async move {
        // Until either end is gone: then the other one hears of it.
        tokio::select! {
            () = carry(from_port, to_station, character) => {}
            () = carry(from_station, to_port, character) => {}
        }
    });
    here
}

/// Hands over each character when its time on the wire is over, or soon after.
async fn carry(
    mut from: impl AsyncRead + Unpin,
    mut to: impl AsyncWrite + Unpin,
    character: Duration,
) {
    let mut piece = [0; 64];
    let mut free_at = Instant::now();
    while let Ok(len @ 1..) = from.read(&mut piece).await {
        let mut rest = piece.get(..len).unwrap_or_default();
        free_at = free_at.max(Instant::now());
        while !rest.is_empty() {
            sleep_until(free_at + character).await;
            let mut due = 0;
            while due < rest.len() && free_at + character <= Instant::now() {
                free_at += character;
                due += 1;
            }
            let (now, later) = rest.split_at(due);
            if to.write_all(now).await.is_err() || to.flush().await.is_err() {
                return;
            }
            rest = later;
        }
    }
}
