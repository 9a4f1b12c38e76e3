//! The inner corners of a chessboard.
//!
//! ```text
//!  ##  ##        where four squares meet the grey is a saddle: S = Ixy^2 - Ixx Iyy is large
//!    ##  ##      on a circle around it light and dark change four times
//!  ##  ##        between neighbours along an edge of squares, one side is dark and the other light
//! ```
//!
//! Saddles are found, made exact, and joined to a grid from neighbour to neighbour. A board is found when exactly `columns` x `rows`
//! corners make a full grid.
//!
//! Sources: the saddle is the Hessian's (Chen and Zhang, 2005); the exact place is where all gradients around point away from (Förstner
//! and Gülch, 1987).

use crate::image::{GreyImage, halve};
use std::collections::{HashMap, VecDeque};

/// Longest side that saddles are searched on.
const WORK: usize = 1000;

type Point = [f64; 2];

/// The inner corners of a board of `columns` x `rows` of them, by rows, pixels with centres at .5; `None` when there is not the whole
/// board. The first corner is that of one of the two ends; clockwise order on the screen.
pub fn find(image: &GreyImage, columns: usize, rows: usize) -> Option<Vec<Point>> {
    // Small enough that noise and blur don't matter.
    let mut owned: Vec<(usize, usize, Vec<u8>)> = Vec::new();
    let mut scale = 1.0;
    loop {
        let (width, height, pixels) = match owned.last() {
            None if image.width().max(image.height()) <= WORK => break,
            None => (image.width(), image.height(), None),
            Some((w, h, _)) if *w.max(h) <= WORK => break,
            Some((w, h, pixels)) => (*w, *h, Some(pixels)),
        };
        let from = match pixels {
            Some(pixels) => GreyImage::new(width, height, width, pixels)?,
            None => *image,
        };
        let mut half = vec![0; (width / 2) * (height / 2)];
        halve(&from, &mut half);
        owned.push((width / 2, height / 2, half));
        scale *= 2.0;
    }
    let small = match owned.last() {
        Some((w, h, pixels)) => GreyImage::new(*w, *h, *w, pixels)?,
        None => *image,
    };
    let wanted = columns * rows;
    let corners: Vec<Point> = saddles(&small, 6 * wanted)
        .into_iter()
        .filter_map(|point| exact(&small, point, 4.0))
        .filter(|point| is_crossing(&small, *point))
        .collect();
    let grid = grid(&small, &corners, columns, rows)?;
    // Then in the picture itself, in a window that doesn't reach the next corners.
    let spacing = (0..wanted).filter(|i| i % columns > 0).map(|i| distance(grid[i], grid[i - 1]));
    let least = spacing.fold(f64::INFINITY, f64::min);
    let window = (0.3 * least * scale).clamp(2.0, 8.0);
    grid.into_iter().map(|point| exact(image, point.map(|x| x * scale), window)).collect()
}

fn distance(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// The strongest saddles, at most `most`.
fn saddles(image: &GreyImage, most: usize) -> Vec<Point> {
    let (width, height) = (image.width(), image.height());
    if width < 16 || height < 16 {
        return Vec::new();
    }
    let smooth = smoothed(image);
    let at = |x: usize, y: usize| smooth[y * width + x];
    let mut strength = vec![0.0f32; width * height];
    let mut strongest = 0.0f32;
    for y in 2..height - 2 {
        for x in 2..width - 2 {
            let xx = at(x - 2, y) - 2.0 * at(x, y) + at(x + 2, y);
            let yy = at(x, y - 2) - 2.0 * at(x, y) + at(x, y + 2);
            let xy =
                (at(x - 2, y - 2) + at(x + 2, y + 2) - at(x + 2, y - 2) - at(x - 2, y + 2)) / 4.0;
            let s = xy * xy - xx * yy;
            strength[y * width + x] = s;
            strongest = strongest.max(s);
        }
    }
    let mut found: Vec<(f32, Point)> = Vec::new();
    const AROUND: usize = 3;
    for y in AROUND..height - AROUND {
        for x in AROUND..width - AROUND {
            let s = strength[y * width + x];
            if s < 0.02 * strongest {
                continue;
            }
            let greatest = (y - AROUND..=y + AROUND)
                .all(|v| (x - AROUND..=x + AROUND).all(|u| strength[v * width + u] <= s));
            if greatest {
                found.push((s, [x as f64 + 0.5, y as f64 + 0.5]));
            }
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.truncate(most);
    found.into_iter().map(|(_, point)| point).collect()
}

/// A 5 x 5 binomial.
fn smoothed(image: &GreyImage) -> Vec<f32> {
    const WEIGHTS: [f32; 5] = [1.0, 4.0, 6.0, 4.0, 1.0];
    let (width, height) = (image.width(), image.height());
    let place = |i: usize, k: usize, most: usize| (i + k).saturating_sub(2).min(most - 1);
    let mut rows = vec![0.0; width * height];
    for y in 0..height {
        let row = image.row(y);
        for x in 0..width {
            rows[y * width + x] =
                (0..5).map(|k| WEIGHTS[k] * f32::from(row[place(x, k, width)])).sum::<f32>() / 16.0;
        }
    }
    let mut smooth = vec![0.0; width * height];
    for y in 0..height {
        for x in 0..width {
            smooth[y * width + x] =
                (0..5).map(|k| WEIGHTS[k] * rows[place(y, k, height) * width + x]).sum::<f32>()
                    / 16.0;
        }
    }
    smooth
}

/// The point q where the gradients g around obey g . (p - q) = 0 best; `None` when it runs away.
fn exact(image: &GreyImage, start: Point, window: f64) -> Option<Point> {
    let reach = window.ceil() as i32;
    let mut q = start;
    for _ in 0..20 {
        let (mut xx, mut xy, mut yy, mut bx, mut by) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for j in -reach..=reach {
            for i in -reach..=reach {
                let (dx, dy) = (f64::from(i), f64::from(j));
                let weight = (-(dx * dx + dy * dy) / (window * window)).exp();
                let [x, y] = [q[0] + dx, q[1] + dy];
                let gx = (image.sample(x + 1.0, y) - image.sample(x - 1.0, y)) / 2.0;
                let gy = (image.sample(x, y + 1.0) - image.sample(x, y - 1.0)) / 2.0;
                let (a, b, c) = (weight * gx * gx, weight * gx * gy, weight * gy * gy);
                xx += a;
                xy += b;
                yy += c;
                bx += a * dx + b * dy;
                by += b * dx + c * dy;
            }
        }
        let determinant = xx * yy - xy * xy;
        if determinant < 1e-3 * (xx + yy) * (xx + yy) {
            return None;
        }
        let step = [(yy * bx - xy * by) / determinant, (xx * by - xy * bx) / determinant];
        q = [q[0] + step[0], q[1] + step[1]];
        if distance(q, start) > window {
            return None;
        }
        if step[0].hypot(step[1]) < 1e-3 {
            break;
        }
    }
    Some(q)
}

/// Do light and dark change four times on a circle?
fn is_crossing(image: &GreyImage, [x, y]: Point) -> bool {
    const POINTS: usize = 24;
    let values: Vec<f64> = (0..POINTS)
        .map(|i| {
            let angle = i as f64 / POINTS as f64 * std::f64::consts::TAU;
            image.sample(x + 4.5 * angle.cos(), y + 4.5 * angle.sin())
        })
        .collect();
    let mean = values.iter().sum::<f64>() / POINTS as f64;
    let changes = (0..POINTS).filter(|&i| (values[i] > mean) != (values[(i + 1) % POINTS] > mean));
    let spread = values.iter().fold(0.0f64, |most, value| most.max((value - mean).abs()));
    changes.count() == 4 && spread > 6.0
}

/// Does an edge between squares run from a to b?
fn is_edge(image: &GreyImage, a: Point, b: Point) -> bool {
    let length = distance(a, b);
    let normal = [(a[1] - b[1]) / length, (b[0] - a[0]) / length];
    let offset = (0.2 * length).max(1.5);
    let mut sign = 0.0f64;
    // The same side is dark all along.
    [0.3, 0.5, 0.7].into_iter().all(|t| {
        let [x, y] = [0, 1].map(|i| a[i] + (b[i] - a[i]) * t);
        let side = |s: f64| image.sample(x + s * offset * normal[0], y + s * offset * normal[1]);
        let step = side(1.0) - side(-1.0);
        let same = sign == 0.0 || step * sign > 0.0;
        sign = step;
        same && step.abs() > 8.0
    })
}

/// Joins corners to the full grid.
fn grid(image: &GreyImage, corners: &[Point], columns: usize, rows: usize) -> Option<Vec<Point>> {
    let wanted = columns * rows;
    let mut tried = vec![false; corners.len()];
    for seed in 0..corners.len() {
        if tried[seed] {
            continue;
        }
        let Some(places) = grow(image, corners, seed) else { continue };
        for &index in places.values() {
            tried[index] = true;
        }
        let low = [0, 1].map(|i| places.keys().map(|key| [key.0, key.1][i]).min().unwrap_or(0));
        let high = [0, 1].map(|i| places.keys().map(|key| [key.0, key.1][i]).max().unwrap_or(0));
        let size = [0, 1].map(|i| (high[i] - low[i] + 1) as usize);
        if places.len() != wanted || size[0] * size[1] != wanted {
            continue;
        }
        let turned = size != [columns, rows];
        if turned && size != [rows, columns] {
            continue;
        }
        let at = |column: usize, row: usize| {
            let (i, j) = if turned { (row, column) } else { (column, row) };
            corners[places[&(low[0] + i as i32, low[1] + j as i32)]]
        };
        let mut grid: Vec<Point> =
            (0..wanted).map(|index| at(index % columns, index / columns)).collect();
        // Clockwise on the screen: a mirrored board would be no rotation.
        let [a, b, c] = [grid[0], grid[columns - 1], grid[wanted - columns]];
        let turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if turn < 0.0 {
            grid.chunks_mut(columns).for_each(|row| row.reverse());
        }
        return Some(grid);
    }
    None
}

/// The corners reached from a seed, with their places in its grid.
fn grow(image: &GreyImage, corners: &[Point], seed: usize) -> Option<HashMap<(i32, i32), usize>> {
    let origin = corners[seed];
    let mut near: Vec<usize> = (0..corners.len()).filter(|&i| i != seed).collect();
    near.sort_by(|&a, &b| distance(corners[a], origin).total_cmp(&distance(corners[b], origin)));
    near.truncate(12);
    near.retain(|&i| is_edge(image, origin, corners[i]));
    let first = *near.first()?;
    let along = |i: usize| [corners[i][0] - origin[0], corners[i][1] - origin[1]];
    let second = *near.iter().find(|&&i| {
        let (a, b) = (along(first), along(i));
        let cross = a[0] * b[1] - a[1] * b[0];
        cross.abs() > 0.5 * a[0].hypot(a[1]) * b[0].hypot(b[1])
    })?;
    let mut places = HashMap::from([((0, 0), seed)]);
    let mut used = vec![false; corners.len()];
    used[seed] = true;
    // Each place with the steps to its neighbours, which change slowly across the board.
    let mut queue = VecDeque::from([((0i32, 0i32), [along(first), along(second)])]);
    while let Some((place, steps)) = queue.pop_front() {
        let here = corners[places[&place]];
        for (axis, sign) in [(0, 1), (0, -1), (1, 1), (1, -1)] {
            let next =
                if axis == 0 { (place.0 + sign, place.1) } else { (place.0, place.1 + sign) };
            if places.contains_key(&next) {
                continue;
            }
            let step = steps[axis].map(|x| x * f64::from(sign));
            let length = step[0].hypot(step[1]);
            let goal = [here[0] + step[0], here[1] + step[1]];
            let best = (0..corners.len())
                .filter(|&i| !used[i])
                .min_by(|&a, &b| distance(corners[a], goal).total_cmp(&distance(corners[b], goal)));
            let Some(best) = best else { continue };
            if distance(corners[best], goal) > 0.35 * length || !is_edge(image, here, corners[best])
            {
                continue;
            }
            used[best] = true;
            places.insert(next, best);
            let mut new = steps;
            new[axis] = [0, 1].map(|i| (corners[best][i] - here[i]) * f64::from(sign));
            queue.push_back((next, new));
        }
    }
    Some(places)
}
