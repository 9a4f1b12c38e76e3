//! Sheets that each cover the whole picture, drawn from the farthest to the nearest, so that every pixel of every sheet
//! passes the depth test: a frame of them tells the fill rate.
//!
//! ```text
//!   eye      nearest sheet        farthest
//!    o  <      / / / / / / / /    all tilted alike: 1/w differs from pixel to pixel, and no sheet cuts another
//! ```

use scanout_assets::{MeshBuf, NormalsBuf};

use crate::sphere::edges_of;

/// Number of sheets.
pub const COUNT: usize = 8;

/// What mesh position 1.0 measures in the world: a sheet is 4 x 4 world units, the view 3.3 x 2.5 at the farthest.
pub const SCALE: f64 = 2.0;

/// World units from a sheet to the next nearer one.
const SPACING: f64 = 0.1;

/// Repeats of the texture along a sheet's side: about one texel a pixel at 640 x 480.
const REPEATS: i32 = 3;

/// All sheets, two triangles each. Their corners' normals differ, so that Gouraud colours do.
pub fn sheets() -> MeshBuf {
    let mut mesh = MeshBuf::default();
    let mut normals = Vec::new();
    for sheet in 0..COUNT {
        let first = mesh.positions.len() as u16;
        for (x, y) in [(-1, -1), (1, -1), (1, 1), (-1, 1)] {
            let z = sheet as f64 * SPACING + f64::from(x + y) * 0.2;
            let z = (z / SCALE * 32768.0).round() as i16;
            mesh.positions.push([x * 32767, y * 32767, z]);
            normals.push([x * 8000, y * 8000, 12_000]);
            let side = REPEATS << 16;
            mesh.uvs.push([i32::from(x + 1) / 2 * side, i32::from(1 - y) / 2 * side]);
        }
        for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
            mesh.triangles.push([first + a, first + b, first + c]);
        }
    }
    mesh.uv_triangles = mesh.triangles.clone();
    mesh.edges = edges_of(&mesh.triangles);
    mesh.normals = NormalsBuf::Vertex(normals);
    mesh
}

#[cfg(test)]
mod tests {
    use crate::scenes::{Case, Data};

    #[test]
    fn every_sheet_is_nearer_than_the_one_before_and_covers_everything() {
        for look in ["flat", "gouraud", "textured"] {
            let case = Case::parse(&format!("fill:{look}:64x48")).unwrap();
            let mut data = Data::new(case).unwrap();
            assert_eq!(data.pixels(), 8 * 64 * 48);
            let mut before = vec![u16::MAX; 64 * 48];
            // One more sheet at a time.
            let all = data.meshes()[0].triangles.clone();
            for sheets in 1..=super::COUNT {
                data.keep_triangles(&all[..2 * sheets]);
                data.with(|scene, settings, memory| {
                    memory.draw(scene, settings);
                    for (depth, before) in memory.depth.iter().zip(&mut before) {
                        assert!(depth < before, "{look}, sheet {sheets}: {depth} {before}");
                        *before = *depth;
                    }
                });
            }
        }
    }
}
