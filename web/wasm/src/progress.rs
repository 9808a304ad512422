//! How far an operation is, told to the page while it runs.

/// How many parts of a progress are told.
const PARTS: u64 = 50;

/// A progress of at most fifty calls to the page, of one stage of an operation.
pub(crate) fn teller(stage: u32) -> impl FnMut(u64, u64) {
    let mut told = 0;
    move |done, all| {
        let part = done.saturating_mul(PARTS) / all.max(1);
        if part > told {
            told = part;
            tell(stage, part as f64 / PARTS as f64);
        }
    }
}

#[cfg(target_arch = "wasm32")]
fn tell(stage: u32, fraction: f64) {
    #[link(wasm_import_module = "page")]
    #[expect(unsafe_code, reason = "a function of the page")]
    unsafe extern "C" {
        safe fn progress(stage: u32, fraction: f64);
    }
    progress(stage, fraction);
}

#[cfg(not(target_arch = "wasm32"))]
const fn tell(_: u32, _: f64) {}
