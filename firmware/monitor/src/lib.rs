//! What a board's display shows, on the PC: see the program; and what it should show.

pub mod expected;
