//! Nothing is linked but what the crates bring along.

fn main() {
    for argument in [
        "-nostartfiles",
        "-nostdlib",
        "-static",
        // Nobody would relocate it.
        "-no-pie",
        "-Wl,--no-undefined",
        // The precompiled `core` names it; nothing calls it with panic = "abort".
        "-Wl,--defsym=rust_eh_personality=0",
    ] {
        println!("cargo:rustc-link-arg-bins={argument}");
    }
    println!("cargo:rerun-if-changed=build.rs");
}
