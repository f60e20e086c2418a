//! A filter alone, for a renderer that has texture coordinates and derivatives of its own.
//!
//!     cargo run --release --example filter_alone
//!
//! White ridges stand between black joints. The lower the eye, the more of the joints hides behind
//! the ridges. Prints how bright a pixel is from above and from ever lower, by the default filter,
//! by the paper's own method, and by one that does not ask what is hidden.

use basrelief::filter::{Footprint, Prepared};
use basrelief::texture::{ColorImage, HeightImage, Surface, SurfaceMaps};
use basrelief::{Ewa, Filter, Result, Visible};

fn main() {
    if let Err(error) = compare() {
        // One line for a person.
        eprintln!("{error}");
        std::process::exit(1);
    }
}

fn compare() -> Result<()> {
    // Four ridges a repeat, 64 x 64 texels; the joints are a tenth of a repeat deep.
    let is_ridge = |x: u32| x % 16 < 8;
    let color = |x, _| if is_ridge(x) { [1.0; 3] } else { [0.0; 3] };
    let height = |x, _| if is_ridge(x) { 1.0 } else { 0.0 };
    let surface = Surface::new(SurfaceMaps {
        albedo: Some(ColorImage::from_fn(64, 64, color)),
        height: Some(HeightImage::from_fn(64, 64, height)),
        relief_depth: 0.1,
        ..SurfaceMaps::default()
    })?;
    // Once a surface; copies are cheap and share what is made.
    let ground = Prepared::new(surface);

    // Many pixels a call. Each has a place, its derivatives to the right and down the screen, and
    // the direction from the eye: along u, along v, and down. All are in repeats of the texture.
    let slopes = [0.0, 0.5, 1.0, 2.0, 4.0];
    let pixels: Vec<Footprint> = slopes
        .iter()
        .map(|&slope| ground.footprint([0.3, 0.7], [0.5, 0.0], [0.0, 0.1], [slope, 0.0, 1.0]))
        .collect();

    // The options of a filter travel with it.
    let paper = Filter::Visible(Visible::default());
    let filters = [Filter::default(), paper, Filter::Ewa(Ewa::default())];
    let columns = filters.map(|filter| ground.colors(&filter, &pixels));

    println!("along u for 1 down   horizon   visible       ewa");
    for (i, slope) in slopes.iter().enumerate() {
        let [horizon, visible, ewa] = [0, 1, 2].map(|column| columns[column][i][0]);
        println!("{slope:18.1} {horizon:9.3} {visible:9.3} {ewa:9.3}");
    }
    Ok(())
}
