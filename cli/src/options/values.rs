//! Options that are numbers, vectors, colours or sizes. Each parser says in a few words what it
//! expected. Scene files hold the same values, bounded by the same checks: see `file_values`.

use basrelief::texture::linear_from_srgb8;
use basrelief::{Horizon, Light, Region};
use glam::Vec3;

/// Width and height in pixels from `1280x720`.
pub(crate) fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once(['x', 'X']).map(|(width, height)| [width, height].map(digits));
    let Some([Some(width), Some(height)]) = sides else {
        return Err("is not WIDTHxHEIGHT in pixels, such as 1280x720".into());
    };
    if ![width, height].iter().all(|side| (1..=32768).contains(side)) {
        return Err("width and height must be within 1 to 32768 pixels".into());
    }
    Ok([width, height])
}

/// A part of a frame in pixels from `X,Y,W,H`.
pub(crate) fn region(text: &str) -> Result<Region, String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|part| digits(part.trim())).collect();
    match numbers.as_deref() {
        Some(&[x, y, width, height]) => Ok(Region { x, y, width, height }),
        _ => Err("is not X,Y,WIDTH,HEIGHT in pixels".into()),
    }
}

/// A number without sign or blank.
pub(crate) fn digits(text: &str) -> Option<u32> {
    text.bytes().all(|b| b.is_ascii_digit()).then(|| text.parse().ok()).flatten()
}

/// A pixel's column and row from `X,Y`.
pub(crate) fn pixel(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once(',').map(|(x, y)| [x.trim(), y.trim()].map(digits));
    match sides {
        Some([Some(x), Some(y)]) => Ok([x, y]),
        _ => Err("is not X,Y in whole pixels, such as 320,200".into()),
    }
}

/// A finite number within 1e18.
pub(crate) fn number(text: &str) -> Result<f32, String> {
    check::number(text.trim().parse().map_err(|_| format!("{text:?} is not a number"))?)
}

/// How finely the horizon and EWA cut footprints: a named point or a number.
pub(crate) fn lines(text: &str) -> Result<u32, String> {
    match text {
        "fast" => Ok(4),
        "default" => Ok(Horizon::default().lines),
        "best" => Ok(24),
        // The settings know the range.
        _ => digits(text.trim()).ok_or_else(|| "is not fast, default, best or a number".into()),
    }
}

/// A number of degrees above 0 and below 180.
pub(crate) fn field_of_view(text: &str) -> Result<f32, String> {
    check::field_of_view(number(text)?)
}

/// A number of degrees from -360 to 360.
pub(crate) fn turn(text: &str) -> Result<f32, String> {
    check::turn(number(text)?)
}

/// A number of degrees from 0 to 180.
pub(crate) fn crease_angle(text: &str) -> Result<f32, String> {
    check::crease_angle(number(text)?)
}

/// The height of an orthographic picture.
pub(crate) fn picture_height(text: &str) -> Result<f32, String> {
    check::picture_height(number(text)?)
}

/// A number above 0.
pub(crate) fn above_zero(text: &str) -> Result<f32, String> {
    check::above_zero(number(text)?)
}

/// A number above 0 and up to 1.
pub(crate) fn fraction(text: &str) -> Result<f32, String> {
    let value = above_zero(text)?;
    if value <= 1.0 { Ok(value) } else { Err("must be above 0 and up to 1".into()) }
}

/// A number from 0 to 1.
pub(crate) fn unit(text: &str) -> Result<f32, String> {
    check::unit(number(text)?)
}

/// Decibels, 0 or more.
pub(crate) fn decibels(text: &str) -> Result<f64, String> {
    let value = number(text)?;
    if value >= 0.0 { Ok(f64::from(value)) } else { Err("must be 0 or more".into()) }
}

fn numbers(text: &str) -> Result<Vec<f32>, String> {
    text.split(',').map(number).collect()
}

/// `X,Y,Z`.
pub(crate) fn vector(text: &str) -> Result<Vec3, String> {
    match numbers(text)?[..] {
        [x, y, z] => Ok(Vec3::new(x, y, z)),
        _ => Err("is not three numbers X,Y,Z".into()),
    }
}

/// Focal lengths and optical axis `FX,FY,CX,CY`.
pub(crate) fn intrinsics(text: &str) -> Result<[f32; 4], String> {
    let four = <[f32; 4]>::try_from(numbers(text)?);
    check::intrinsics(four.map_err(|_| "is not four numbers FX,FY,CX,CY")?)
}

/// A matrix from a camera's axes to the world, row by row.
pub(crate) type Pose = [[f32; 4]; 4];

/// A pose: 16 numbers, row by row.
pub(crate) fn pose(text: &str) -> Result<Pose, String> {
    let pose = <[f32; 16]>::try_from(numbers(text)?).map_err(|_| "is not 16 numbers")?;
    check::pose([0, 4, 8, 12].map(|i| [pose[i], pose[i + 1], pose[i + 2], pose[i + 3]]))
}

/// A direction `X,Y,Z` that is not zero.
pub(crate) fn direction(text: &str) -> Result<Vec3, String> {
    check::direction(vector(text)?)
}

/// Linear RGB from `R,G,B` or one number for all three.
pub(crate) fn intensity(text: &str) -> Result<Vec3, String> {
    match numbers(text)?[..] {
        [gray] => check::intensity(Vec3::splat(gray)),
        [r, g, b] => check::intensity(Vec3::new(r, g, b)),
        _ => Err("is not one number or three numbers R,G,B".into()),
    }
}

/// A light: its place or direction `X,Y,Z` and its linear RGB, 1 where `R,G,B` is left out.
pub(crate) fn light(text: &str) -> Result<[Vec3; 2], String> {
    match numbers(text)?[..] {
        [x, y, z] => Ok([Vec3::new(x, y, z), Vec3::ONE]),
        [x, y, z, r, g, b] => Ok([Vec3::new(x, y, z), check::intensity(Vec3::new(r, g, b))?]),
        _ => Err("is not X,Y,Z or X,Y,Z,R,G,B".into()),
    }
}

/// A sun: the direction `X,Y,Z` towards it, its linear RGB, 1 where `R,G,B` is left out, and its
/// diameter in degrees, where `SIZE` is left out that of the real one.
pub(crate) fn sun(text: &str) -> Result<(Vec3, Vec3, f32), String> {
    let numbers = numbers(text)?;
    let (place, rest) =
        numbers.split_first_chunk().ok_or("is not X,Y,Z, X,Y,Z,R,G,B or X,Y,Z,R,G,B,SIZE")?;
    let to_light = check::direction(Vec3::from_array(*place))
        .map_err(|reason| format!("its direction {reason}"))?;
    let (color, size) = match *rest {
        [] => (Vec3::ONE, Light::SUN_SIZE),
        [r, g, b] => (Vec3::new(r, g, b), Light::SUN_SIZE),
        [r, g, b, size] => (Vec3::new(r, g, b), size),
        _ => return Err("is not X,Y,Z, X,Y,Z,R,G,B or X,Y,Z,R,G,B,SIZE".into()),
    };
    Ok((to_light, check::intensity(color)?, check::sun_size(size)?))
}

/// A sky: linear RGB from `R,G,B` or one number for all three, or three such colours, `TOP`,
/// `HORIZON` and `GROUND`, with slashes between them.
pub(crate) fn sky(text: &str) -> Result<[Vec3; 3], String> {
    let colors: Result<Vec<Vec3>, String> = text.split('/').map(intensity).collect();
    match colors?[..] {
        [color] => Ok([color; 3]),
        [top, horizon, ground] => Ok([top, horizon, ground]),
        _ => Err("is not a colour R[,G,B] or three colours TOP/HORIZON/GROUND".into()),
    }
}

/// Ranges of values, wherever they come from.
pub(crate) mod check {
    use super::Pose;
    use basrelief::{Camera, Error, Intrinsics, PoseAxes};
    use glam::Vec3;

    pub(crate) fn intrinsics(value: [f32; 4]) -> Result<[f32; 4], String> {
        let [fx, fy, cx, cy] = value;
        let intrinsics = Some(Intrinsics { fx, fy, cx, cy });
        match (Camera { intrinsics, ..Camera::default() }).validate() {
            Ok(()) => Ok(value),
            Err(_) => {
                Err("must have focal lengths of 1e-3 to 1e6, and the axis within -32768 to 65536"
                    .into())
            }
        }
    }

    pub(crate) fn pose(value: Pose) -> Result<Pose, String> {
        // Both kinds of axes are a rotation if one is.
        Camera::default().posed(&value, PoseAxes::OpenCv).map(|_| value).map_err(|e| match e {
            Error::Scene { reason, .. } => reason,
            e => e.to_string(),
        })
    }

    pub(crate) fn number(value: f32) -> Result<f32, String> {
        // Squares of larger numbers leave the range of f32.
        if value.abs() <= 1e18 {
            Ok(value)
        } else {
            Err(format!("{value} is not within -1e18 to 1e18"))
        }
    }

    pub(crate) fn field_of_view(value: f32) -> Result<f32, String> {
        if value > 0.0 && value < 180.0 {
            Ok(value)
        } else {
            Err("must be above 0 and below 180 degrees".into())
        }
    }

    pub(crate) fn crease_angle(value: f32) -> Result<f32, String> {
        if (0.0..=180.0).contains(&value) {
            Ok(value)
        } else {
            Err("must be within 0 to 180 degrees".into())
        }
    }

    pub(crate) fn picture_height(value: f32) -> Result<f32, String> {
        match (Camera { orthographic: Some(value), ..Camera::default() }).validate() {
            Ok(()) => Ok(value),
            Err(_) => Err("must be within 1e-9 to 1e9".into()),
        }
    }

    pub(crate) fn above_zero(value: f32) -> Result<f32, String> {
        if value > 0.0 { number(value) } else { Err("must be above 0".into()) }
    }

    pub(crate) fn unit(value: f32) -> Result<f32, String> {
        if (0.0..=1.0).contains(&value) { Ok(value) } else { Err("must be within 0 to 1".into()) }
    }

    pub(crate) fn turn(value: f32) -> Result<f32, String> {
        if (-360.0..=360.0).contains(&value) {
            Ok(value)
        } else {
            Err("must be within -360 to 360 degrees".into())
        }
    }

    pub(crate) fn sun_size(value: f32) -> Result<f32, String> {
        if (0.0..=90.0).contains(&value) {
            Ok(value)
        } else {
            Err("its size must be within 0 to 90 degrees".into())
        }
    }

    pub(crate) fn vector(value: Vec3) -> Result<Vec3, String> {
        value
            .to_array()
            .into_iter()
            .try_for_each(|component| number(component).map(drop))
            .map(|()| value)
    }

    pub(crate) fn direction(value: Vec3) -> Result<Vec3, String> {
        if vector(value)?.length_squared() >= 1e-30 {
            Ok(value)
        } else {
            Err("must not be zero".into())
        }
    }

    pub(crate) fn intensity(value: Vec3) -> Result<Vec3, String> {
        if value.min_element() >= 0.0 && value.max_element() <= 1e6 {
            Ok(value)
        } else {
            Err("intensities must be within 0 to 1e6".into())
        }
    }
}

/// Names of colours, as CSS has them.
const COLORS: &[(&str, [u8; 3])] = &[
    ("black", [0, 0, 0]),
    ("silver", [192, 192, 192]),
    ("gray", [128, 128, 128]),
    ("grey", [128, 128, 128]),
    ("white", [255, 255, 255]),
    ("maroon", [128, 0, 0]),
    ("red", [255, 0, 0]),
    ("orange", [255, 165, 0]),
    ("purple", [128, 0, 128]),
    ("magenta", [255, 0, 255]),
    ("green", [0, 128, 0]),
    ("lime", [0, 255, 0]),
    ("olive", [128, 128, 0]),
    ("yellow", [255, 255, 0]),
    ("navy", [0, 0, 128]),
    ("blue", [0, 0, 255]),
    ("skyblue", [135, 206, 235]),
    ("teal", [0, 128, 128]),
    ("cyan", [0, 255, 255]),
];

/// Linear RGB and opacity from a colour's name, `#rgb`, `#rrggbb`, `R,G,B` of 0 to 255, or
/// `transparent`.
pub(crate) fn color(text: &str) -> Result<[f32; 4], String> {
    let lower = text.trim().to_ascii_lowercase();
    if lower == "transparent" {
        return Ok([0.0; 4]);
    }
    let named = COLORS.iter().find(|(name, _)| *name == lower).map(|&(_, rgb)| rgb);
    let rgb =
        named.or_else(|| lower.strip_prefix('#').and_then(hexadecimal)).or_else(|| decimal(&lower));
    let [r, g, b] = rgb
        .ok_or("is not a colour: use #rrggbb, R,G,B of 0 to 255, transparent, or a name such as white or skyblue")?
        .map(linear_from_srgb8);
    Ok([r, g, b, 1.0])
}

fn hexadecimal(text: &str) -> Option<[u8; 3]> {
    let digits: Option<Vec<u8>> =
        text.chars().map(|c| c.to_digit(16).map(|digit| digit as u8)).collect();
    match digits?[..] {
        [r, g, b] => Some([r, g, b].map(|digit| digit * 17)),
        [r, s, g, h, b, c] => Some([16 * r + s, 16 * g + h, 16 * b + c]),
        _ => None,
    }
}

fn decimal(text: &str) -> Option<[u8; 3]> {
    let bytes: Option<Vec<u8>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    bytes?.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!(size("1280x720"), Ok([1280, 720]));
        for bad in [
            "",
            "x",
            "12",
            "0x0",
            "0x5",
            "12x",
            "-1x5",
            "1x+5",
            "32769x1",
            "1x1x1",
            "99999999999x1",
        ] {
            assert!(size(bad).is_err(), "{bad}");
        }
        assert_eq!(region("1, 2,3,4"), Ok(Region { x: 1, y: 2, width: 3, height: 4 }));
        assert!(
            ["", "1,2,3", "1,2,3,4,5", "-1,2,3,4", "1,2,3,+4", "1 2,3,4"]
                .iter()
                .all(|bad| region(bad).is_err())
        );
    }

    #[test]
    fn pixels() {
        assert_eq!(pixel("3,40"), Ok([3, 40]));
        assert_eq!(pixel("3, 40"), Ok([3, 40]));
        for bad in ["", "3", "3,", ",3", "-1,2", "1.5,2", "1,2,3", "99999999999,1"] {
            assert!(pixel(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn numbers_are_finite() {
        assert_eq!(vector("-1, 2e3,.5"), Ok(Vec3::new(-1.0, 2000.0, 0.5)));
        for bad in
            ["nan,0,0", "1,inf,0", "1e39,0,0", "1e30,0,0", "1,2", "1,2,3,4", "", "1,,2", "a,b,c"]
        {
            assert!(vector(bad).is_err(), "{bad}");
        }
        assert_eq!(light("1,2,3"), Ok([Vec3::new(1.0, 2.0, 3.0), Vec3::ONE]));
        assert_eq!(light("1,2,3,4,5,6").map(|l| l[1]), Ok(Vec3::new(4.0, 5.0, 6.0)));
        assert!(["1,2,3,-1,0,0", "1,2,3,nan,0,0", "1,2,3,4"].iter().all(|bad| light(bad).is_err()));
        assert!(
            ["0,0,0", "0,0,0,1,1,1"].iter().all(|bad| sun(bad).is_err())
                && direction("0,0,0").is_err()
        );
        assert_eq!(intensity("0.5"), Ok(Vec3::splat(0.5)));
        assert!(["0", "180", "-5", "nan"].iter().all(|bad| field_of_view(bad).is_err()));
        assert!(["-1", "181", "nan"].iter().all(|bad| crease_angle(bad).is_err()));
        assert!(["0", "1.5", "-5", "nan"].iter().all(|bad| fraction(bad).is_err()));
    }

    #[test]
    fn colors() {
        assert_eq!(color("White"), Ok([1.0; 4]));
        assert_eq!(color("transparent"), Ok([0.0; 4]));
        for same in ["#ff8000", "#FF8000", "255,128,0", "255, 128, 0"] {
            assert_eq!(color(same), Ok([1.0, linear_from_srgb8(128), 0.0, 1.0]), "{same}");
        }
        assert_eq!(color("#f00"), color("red"));
        for bad in ["", "#", "#ff", "#ggg", "256,0,0", "1,2", "nan,0,0", "reddish", "#ff80é"] {
            assert!(color(bad).is_err(), "{bad}");
        }
    }
}
