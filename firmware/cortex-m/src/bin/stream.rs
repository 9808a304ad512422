//! On a board: plays a stream of segments that comes over a serial line, by timer interrupts, and
//! says when each edge came. On a PC: plans a line, sends it while it is played, is late on purpose
//! if told so, and checks the edges.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg_attr(target_os = "none", path = "stream/board.rs")]
#[cfg_attr(not(target_os = "none"), path = "stream/pc.rs")]
mod machine;

#[cfg(not(target_os = "none"))]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    machine::main()
}
