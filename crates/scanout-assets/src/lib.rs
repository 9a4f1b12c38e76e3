//! Mesh and texture readers for scanout.
#![cfg_attr(not(feature = "std"), no_std)]
