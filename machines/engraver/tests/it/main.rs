//! All tests of the engraver alone: one program, which is linked once.
#![cfg(test)]

mod load;
