//! Bresenham lines.
