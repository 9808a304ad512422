//! What every program runs on, and when it ends.

use core::future::Future;

use anyhow::{Context as _, Result};
use tokio::signal::ctrl_c;

/// Runs a program on this thread.
pub(crate) fn block_on<T>(program: impl Future<Output = Result<T>>) -> Result<T> {
    let mut runtime = tokio::runtime::Builder::new_current_thread();
    let runtime = runtime.enable_all().build();
    runtime
        .context("the asynchronous runtime")?
        .block_on(program)
}

/// Returns when the program is to end: Ctrl-C, or SIGTERM on Unix.
pub(crate) async fn interrupted() -> Result<()> {
    #[cfg(unix)]
    {
        use tokio::signal::unix::{SignalKind, signal};
        let mut terminated = signal(SignalKind::terminate()).context("SIGTERM")?;
        tokio::select! {
            pressed = ctrl_c() => pressed.context("Ctrl-C"),
            _ = terminated.recv() => Ok(()),
        }
    }
    #[cfg(not(unix))]
    ctrl_c().await.context("Ctrl-C")
}
