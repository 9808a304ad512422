//! Ports of the tests' own.

use core::{
    net::Ipv4Addr,
    sync::atomic::{AtomicU16, Ordering},
};
use std::{net, process, sync::LazyLock};

use tokio::net::TcpListener;

/// For partners, on a port that nobody had before: a gateway that has lost its partner goes on
/// asking, and is not to find that of another test.
pub(crate) fn listen() -> TcpListener {
    let listener = next();
    listener.set_nonblocking(true).unwrap();
    TcpListener::from_std(listener).unwrap()
}

/// Ports that nobody has right now, and that no system gives to whoever asks for any.
pub(crate) fn free_ports<const N: usize>() -> [u16; N] {
    let listeners = [(); N].map(|()| next());
    listeners.map(|listener| listener.local_addr().unwrap().port())
}

fn next() -> net::TcpListener {
    const RANGE: (u16, u16) = (10_000, 32_000);
    /// Other test programs begin elsewhere.
    static NEXT: LazyLock<AtomicU16> = LazyLock::new(|| {
        let id = process::id().wrapping_mul(2_654_435_761) >> 16;
        AtomicU16::new(u16::try_from(id).unwrap())
    });
    loop {
        let port = RANGE.0 + NEXT.fetch_add(1, Ordering::Relaxed) % (RANGE.1 - RANGE.0);
        if let Ok(listener) = net::TcpListener::bind((Ipv4Addr::LOCALHOST, port)) {
            return listener;
        }
    }
}
