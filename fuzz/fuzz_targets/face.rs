#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| scanout_fuzz::face(bytes));
