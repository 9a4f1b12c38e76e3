//! Deterministic fuzzing on stable Rust: mutates the seeds of each target and reports time and memory.
//!
//! `cargo run --release --bin smoke -- [--seconds N] [--iterations N] [TARGET...]`
//!
//! Every target gets the same share of the time. The mutations depend only on the target and the number of the
//! iteration, so a failure is repeated by the same command; the input that failed is kept as `fuzz/failed-TARGET`.
//! Bounds: an input may take 2 seconds and the process 1 GiB.

use scanout_fuzz::{TARGETS, Target};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// Seeds larger than this make few iterations a second.
const SEED_BYTES: u64 = 200_000;
/// The longest that one input may take.
const SLOW: Duration = Duration::from_secs(2);
/// The most memory that the process may have used, in KiB.
const MEMORY: u64 = 1 << 20;

/// xorshift64*, enough to choose places.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    fn below(&mut self, limit: usize) -> usize {
        (self.next() >> 33) as usize % limit.max(1)
    }
}

/// Words that readers treat specially.
const TOKENS: [&[u8]; 24] = [
    b"0",
    b"-1",
    b"4294967295",
    b"4294967296",
    b"18446744073709551615",
    b"1e308",
    b"-1e-308",
    b"nan",
    b"inf",
    b"\n",
    b"\r\n",
    b"\\\n",
    b"/",
    b"#",
    b" ",
    b"\0\0\0\0",
    b"\xff\xff\xff\xff",
    b"\xff\xff\xff\x7f",
    b"f 1 2 3 4 5 6\n",
    b"vertex",
    b"list",
    b"P6 65535 65535 255\n",
    b"[[[[[[[[",
    b"{\"a\":",
];

fn mutate(seeds: &[Vec<u8>], random: &mut Random) -> Vec<u8> {
    let mut bytes = seeds[random.below(seeds.len())].clone();
    for _ in 0..=random.below(6) {
        let at = random.below(bytes.len() + 1);
        let end = (at + 1 + random.below(64)).min(bytes.len());
        match random.below(8) {
            0 => bytes.truncate(at),
            1 => {
                let bit = random.below(8);
                bytes.get_mut(at).into_iter().for_each(|b| *b ^= 1 << bit);
            }
            2 => {
                let value = random.next() as u8;
                bytes.get_mut(at).into_iter().for_each(|b| *b = value);
            }
            3 => drop(bytes.drain(at.min(end)..end)),
            4 => {
                let copy = bytes[at.min(end)..end].to_vec();
                let to = random.below(bytes.len() + 1);
                bytes.splice(to..to, copy);
            }
            5 => {
                let token = TOKENS[random.below(TOKENS.len())];
                bytes.splice(at..at, token.iter().copied());
            }
            6 => {
                let token = TOKENS[random.below(TOKENS.len())];
                let end = (at + token.len()).min(bytes.len());
                bytes.splice(at..end, token.iter().copied());
            }
            _ => {
                let other = &seeds[random.below(seeds.len())];
                let from = random.below(other.len() + 1);
                bytes.truncate(at);
                bytes.extend_from_slice(&other[from..]);
            }
        }
    }
    bytes
}

/// The seeds of a target: a few built in, and what `seeds.sh` gathered.
fn seeds(folder: &Path, target: &str) -> Vec<Vec<u8>> {
    let mut seeds: Vec<Vec<u8>> = match target {
        "obj" => vec![b"mtllib a\nv 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\ns 1\nf 1/1/1 2/1/1 -1//-1\nl 1 2\np 3\n".to_vec()],
        "mtl" => vec![b"newmtl a\nKd 1 .5 0\nKa 1 1 1\nKs .5 .5 .5\nNs 10\nd .5\nillum 2\nmap_Kd -s 1 1 1 x.png\n".to_vec()],
        "stl" => vec![b"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n".to_vec()],
        "ply" => vec![b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n".to_vec()],
        "gltf" => vec![br#"{"asset":{"version":"2.0"},"buffers":[{"byteLength":36,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}]}"#.to_vec()],
        "ppm" | "texture" => vec![
            b"P6 # c\n2 2 255\nabcdefghijkl".to_vec(),
            b"P3 1 1 9 1 2 3\n".to_vec(),
            b"P5 2 1 65535 abcd".to_vec(),
        ],
        _ => {
            let model = scanout_assets::load_bytes(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", None, "-", None, &Default::default());
            vec![scanout_assets::bake::to_binary(&model.expect("a triangle")).expect("a small model")]
        }
    };
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder.join(target))
        .into_iter()
        .flatten()
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.metadata().is_ok_and(|m| m.is_file() && m.len() <= SEED_BYTES))
        .collect();
    files.sort();
    seeds.extend(files.into_iter().filter_map(|path| std::fs::read(path).ok()));
    seeds
}

/// Peak memory of this process in KiB, where the system tells.
fn peak_memory() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.split_whitespace().next()?.parse().ok()).unwrap_or(0)
}

fn run(
    name: &str,
    target: Target,
    share: Duration,
    iterations: u64,
    root: &Path,
) -> Result<(), String> {
    let seeds = seeds(&root.join("corpus"), name);
    let begin = Instant::now();
    let mut slowest = Duration::ZERO;
    let mut done = 0;
    while done < iterations && begin.elapsed() < share {
        let mut random =
            Random(0x9e37_79b9_7f4a_7c15 ^ (done + 1).wrapping_mul(0xbf58_476d_1ce4_e5b9));
        let input = match seeds.get(done as usize) {
            Some(seed) => seed.clone(),
            None => mutate(&seeds, &mut random),
        };
        let start = Instant::now();
        let failed = std::panic::catch_unwind(|| target(&input)).is_err();
        let took = start.elapsed();
        slowest = slowest.max(took);
        done += 1;
        if failed || took > SLOW || peak_memory() > MEMORY {
            let kept = root.join(format!("failed-{name}"));
            std::fs::write(&kept, &input).map_err(|error| error.to_string())?;
            let why = if failed { "panicked" } else { "took too much time or memory" };
            return Err(format!("{name}: iteration {done} {why}; the input is {}", kept.display()));
        }
    }
    println!(
        "{name:8} {:4} seeds {done:9} inputs, slowest {:6.1} ms, peak memory so far {:4} MiB",
        seeds.len(),
        slowest.as_secs_f64() * 1e3,
        peak_memory() / 1024
    );
    Ok(())
}

fn main() -> ExitCode {
    let (mut seconds, mut iterations, mut wanted) = (40, u64::MAX, Vec::new());
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut number = || arguments.next().and_then(|n| n.parse::<u64>().ok());
        match argument.as_str() {
            "--seconds" => seconds = number().unwrap_or(seconds),
            "--iterations" => iterations = number().unwrap_or(iterations),
            name => wanted.push(name.to_string()),
        }
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let chosen: Vec<_> = TARGETS
        .iter()
        .filter(|(name, _)| wanted.is_empty() || wanted.iter().any(|w| w == name))
        .collect();
    if chosen.is_empty() {
        eprintln!("no such target; there are {:?}", TARGETS.map(|(name, _)| name));
        return ExitCode::from(2);
    }
    let share = Duration::from_secs(seconds) / chosen.len() as u32;
    for (name, target) in chosen {
        if let Err(error) = run(name, *target, share, iterations, root) {
            eprintln!("{error}");
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}
