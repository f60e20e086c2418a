//! The attribute planes of the triangles that turn out to be visible, eight at a time: lanes are
//! triangles.
//!
//! The ray to a corner, in the corner's texture frame, solves `ray = alpha U + beta V - gamma s N`
//! with `U = dP/du`, `V = dP/dv`, `s = sqrt(|U x V|)`. By Cramer's rule, with `volume = N . (U x
//! V)`, `alpha = (V x N) . ray / volume`, `beta = (N x U) . ray / volume`, `gamma = -(U x V) . ray
//! / (s volume)`. With a frame at each corner, curved surfaces stay smooth; flat triangles whose texture is
//! bent have one frame, their own.

use super::quad::{AttributePlanes, LitPlanes, Plane};
use crate::geometry::{BasisLanes, Geometry, Projection, ScreenTriangle};
use crate::scene::{Mesh, Scene};
use crate::settings::{Lighting, Settings};
use crate::simd::f64x8;
use glam::Vec3;

/// A frame whose volume is less than this share of the product of its lengths counts as flat;
/// tangents in f32 are not known better.
const FLAT: f64 = 1e-6;

/// Least difference of vectors, squared, as a share of their length squared, that is no rounding.
const LEAST_TURN: f64 = 1e-10;

/// Eight vectors of three components.
type Vectors = [f64x8; 3];

/// The corners of a triangle of the scene.
#[derive(Clone, Copy)]
struct Corners<'a> {
    triangle: [u32; 2],
    mesh: &'a Mesh,
    indices: [usize; 3],
}

/// Makes attribute planes of the triangles of a scene.
pub(super) struct PlaneMaker<'a> {
    projection: &'a Projection,
    scene: &'a Scene,
    is_lit: bool,
    parallax: bool,
    has_outlines: bool,
}

impl AttributePlanes {
    /// The planes of the scene's triangle that `triangle` is, or is a piece of.
    pub fn new(
        geometry: &Geometry,
        triangle: &ScreenTriangle,
        scene: &Scene,
        settings: &Settings,
    ) -> Self {
        let mut planes = [Self::default()];
        PlaneMaker::new(geometry, scene, settings)
            .fill(&mut planes, &[[triangle.mesh, triangle.triangle]]);
        let [planes] = planes;
        planes
    }
}

impl<'a> PlaneMaker<'a> {
    pub(super) fn new(geometry: &'a Geometry, scene: &'a Scene, settings: &Settings) -> Self {
        let is_lit = settings.lighting == Lighting::Lit;
        let (parallax, has_outlines) = (settings.parallax, settings.has_outlines());
        Self { projection: geometry.projection(), scene, is_lit, parallax, has_outlines }
    }

    /// Sets the planes of the triangles given by the indices of their mesh and in it.
    pub(super) fn fill(&self, planes: &mut [AttributePlanes], triangles: &[[u32; 2]]) {
        for (planes, triangles) in planes.chunks_mut(8).zip(triangles.chunks(8)) {
            // Lanes without a triangle repeat the last one.
            let corners =
                std::array::from_fn(|lane| self.corners(triangles[lane.min(triangles.len() - 1)]));
            self.fill_lanes(planes, &corners);
        }
    }

    fn corners(&self, [index, triangle]: [u32; 2]) -> Corners<'a> {
        let mesh = &self.scene.meshes[index as usize];
        let indices = mesh.triangles[triangle as usize].map(|i| i as usize);
        Corners { triangle: [index, triangle], mesh, indices }
    }

    fn fill_lanes(&self, planes: &mut [AttributePlanes], corners: &[Corners; 8]) {
        // Set up the planes from the corners before clipping and snapping, in f64: pieces of a
        // triangle then share them.
        let from_eye = vectors(corners, |mesh, i| mesh.positions[i])
            .map(|position| self.projection.as_seen(position));
        let views = from_eye.map(|position| self.projection.views(position));
        let basis = BasisLanes::new(views, &self.projection.lens);
        let (inverse_w, nearness) = (basis.inverse_w(), basis.nearness());
        let tex_coords = vectors(corners, |mesh, i| {
            mesh.tex_coords.get(i).map_or(Vec3::ZERO, |uv| Vec3::new(uv.x, uv.y, 0.0))
        });
        let uv = [0, 1].map(|axis| basis.plane(tex_coords.map(|uv| uv[axis])));
        for (lane, planes) in planes.iter_mut().enumerate() {
            planes.triangle = corners[lane].triangle;
            planes.inverse_w = one(&inverse_w, lane);
            planes.nearness = one(&nearness, lane);
            // Meshes with texture coordinates and without may meet in one vector, so each lane is
            // asked.
            let is_textured = !corners[lane].mesh.tex_coords.is_empty();
            planes.uv =
                if is_textured { [0, 1].map(|i| one(&uv[i], lane)) } else { [Plane::default(); 2] };
            // Straight down, unless a view is found below.
            planes.view = [Plane::default(), Plane::default(), planes.inverse_w];
            planes.bend = [[0.0; 2]; 3];
        }
        // One lane with relief is reason enough to find all eight; flat ones keep what they have.
        if corners.iter().any(|corners| self.needs_view(corners)) {
            let (normals, tangents) = frames(corners);
            let repeats = [0, 1, 2].map(|c| repeat_length(tangents[0][c], tangents[1][c]));
            let tangents = if self.has_outlines {
                own_tangents((&from_eye, &tex_coords), (&normals, tangents))
            } else {
                tangents
            };
            let views = [0, 1, 2].map(|c| {
                let ray = self.projection.rays(from_eye[c]);
                let frame = [tangents[0][c], tangents[1][c]];
                view_in_texture_frame(ray, normals[c], (frame, repeats[c]))
            });
            let view = [0, 1, 2].map(|axis| basis.plane(views.map(|view| view[axis])));
            let planes =
                planes.iter_mut().enumerate().filter(|(lane, _)| self.needs_view(&corners[*lane]));
            // The ray to a place that is a repeat farther is longer by that; parallel ones are not.
            let longer = if self.projection.is_orthographic() { 0.0 } else { 1.0 };
            let bend = bends((&normals, &tangents, &repeats), &tex_coords, (&views, longer));
            planes.for_each(|(lane, planes)| {
                planes.view = [0, 1, 2].map(|i| one(&view[i], lane));
                if self.has_outlines {
                    planes.bend = bend.map(|of| of.map(|lanes| lanes.as_array()[lane] as f32));
                }
            });
        }
        fill_tint(planes, &basis, corners);
        if self.is_lit {
            let across =
                cross(difference(from_eye[1], from_eye[0]), difference(from_eye[2], from_eye[0]));
            let is_back = dot(across, self.projection.rays(from_eye[0])).simd_gt(f64x8::ZERO);
            fill_lit(planes, &basis, (corners, is_back.to_bitmask()));
        } else {
            // Planes are kept from frame to frame, and the frame before may have been lit.
            planes.iter_mut().for_each(|planes| planes.lit = None);
        }
    }

    /// Whether anything may ask for the view: not where there is no relief.
    fn needs_view(&self, corners: &Corners) -> bool {
        let is_flat = |mesh: &Mesh| {
            let surface = self.scene.materials[mesh.material].surface.as_ref();
            mesh.tex_coords.is_empty()
                || surface.is_some_and(|surface| surface.relief_depth() == 0.0)
        };
        self.parallax && !is_flat(corners.mesh)
    }
}

/// Sets the planes of the meshes' colours.
fn fill_tint(planes: &mut [AttributePlanes], basis: &BasisLanes, corners: &[Corners; 8]) {
    let has_colors = |lane: usize| !corners[lane].mesh.colors.is_empty();
    if !(0..8).any(has_colors) {
        // Planes are kept from tile to tile.
        return planes.iter_mut().for_each(|planes| planes.tint = None);
    }
    let colors = vectors(corners, |mesh, i| mesh.colors.get(i).copied().unwrap_or(Vec3::ONE));
    let tint = [0, 1, 2].map(|channel| basis.plane(colors.map(|color| color[channel])));
    for (lane, planes) in planes.iter_mut().enumerate() {
        if has_colors(lane) {
            **planes.tint.get_or_insert_default() = [0, 1, 2].map(|i| one(&tint[i], lane));
        } else {
            planes.tint = None;
        }
    }
}

fn fill_lit(
    planes: &mut [AttributePlanes],
    basis: &BasisLanes,
    (corners, is_back): (&[Corners; 8], u32),
) {
    let positions = vectors(corners, |mesh, i| mesh.positions[i]);
    let (normals, [tangents_u, tangents_v]) = frames(corners);
    let [position, normal, tangent_u, tangent_v] = [positions, normals, tangents_u, tangents_v]
        .map(|vectors| [0, 1, 2].map(|axis| basis.plane(vectors.map(|vector| vector[axis]))));
    for (lane, planes) in planes.iter_mut().enumerate() {
        let three = |of: &[[[f32; 8]; 3]; 3]| [0, 1, 2].map(|axis| one(&of[axis], lane));
        **planes.lit.get_or_insert_default() = LitPlanes {
            position: three(&position),
            normal: three(&normal),
            tangent_u: three(&tangent_u),
            tangent_v: three(&tangent_v),
            is_back: is_back >> lane & 1 == 1,
        };
    }
}

/// The plane of one lane.
#[inline(always)]
fn one(coefficients: &[[f32; 8]; 3], lane: usize) -> Plane {
    coefficients.map(|lanes| lanes[lane])
}

/// A vector of each vertex, corner by corner.
#[inline(always)]
fn vectors(corners: &[Corners; 8], of: impl Fn(&Mesh, usize) -> Vec3) -> [Vectors; 3] {
    [0, 1, 2].map(|corner| {
        let mut lanes = [[0.0_f32; 8]; 3];
        for (lane, Corners { mesh, indices, .. }) in corners.iter().enumerate() {
            let [x, y, z] = of(mesh, indices[corner]).to_array();
            (lanes[0][lane], lanes[1][lane], lanes[2][lane]) = (x, y, z);
        }
        lanes.map(|lanes| f64x8::new(lanes.map(f64::from)))
    })
}

/// Normals, dP/du and dP/dv, corner by corner; tangents are 0 without texture coordinates.
fn frames(corners: &[Corners; 8]) -> ([Vectors; 3], [[Vectors; 3]; 2]) {
    let tangents = [0, 1].map(|axis| {
        vectors(corners, |mesh, i| {
            mesh.tangents.get(i).map_or(Vec3::ZERO, |tangents| tangents[axis])
        })
    });
    (vectors(corners, |mesh, i| mesh.normals[i]), tangents)
}

/// The tangents to view along the relief of a followed mesh: where it is flat, and its texture is bent,
/// those of the triangle itself, along which rays go until they leave by an edge. Over what is curved
/// rays pass many triangles, for which the frames at the corners stand together.
fn own_tangents(
    (positions, tex_coords): (&[Vectors; 3], &[Vectors; 3]),
    (normals, tangents): (&[Vectors; 3], [[Vectors; 3]; 2]),
) -> [[Vectors; 3]; 2] {
    let growth = growth(tex_coords);
    let along = [0, 1, 2].map(|i| growth(positions.map(|position| position[i])));
    let is_finite = |mask, lanes: &f64x8| mask & lanes.is_finite();
    let is_own = (differ(&tangents[0]) | differ(&tangents[1])) & !differ(normals);
    let is_own = along.iter().flatten().fold(is_own, is_finite);
    [0, 1].map(|axis| {
        let own = along.map(|component| component[axis]);
        tangents[axis].map(|of| [0, 1, 2].map(|i| is_own.select(own[i], of[i])))
    })
}

/// By how much a number at the corners of triangles grows per repeat along u and along v.
fn growth(tex_coords: &[Vectors; 3]) -> impl Fn([f64x8; 3]) -> [f64x8; 2] {
    let edge = |i: usize| [0, 1].map(|axis| tex_coords[i][axis] - tex_coords[0][axis]);
    let ([u1, v1], [u2, v2]) = (edge(1), edge(2));
    let area = u1 * v2 - u2 * v1;
    move |corners| {
        let (c1, c2) = (corners[1] - corners[0], corners[2] - corners[0]);
        [(c1 * v2 - c2 * v1) / area, (c2 * u1 - c1 * u2) / area]
    }
}

/// Where vectors at the corners differ by more than rounding.
fn differ(corners: &[Vectors; 3]) -> f64x8 {
    let least = dot(corners[0], corners[0]) * LEAST_TURN;
    let differs = |i: usize| {
        let turn = difference(corners[i], corners[0]);
        dot(turn, turn).simd_gt(least)
    };
    differs(1) | differs(2)
}

/// See [`repeat_length`](crate::light::repeat_length).
fn repeat_length(u: Vectors, v: Vectors) -> f64x8 {
    let across = cross(u, v);
    dot(across, across).sqrt().sqrt()
}

/// `(alpha, beta, gamma)` of rays in the texture frames of vertices, whose relief goes down by so much
/// for each repeat; straight down where there is no frame.
fn view_in_texture_frame(ray: Vectors, n: Vectors, ([u, v], s): ([Vectors; 2], f64x8)) -> Vectors {
    // Find out whether the vectors span a space. Squares are compared, so that no length needs a
    // root.
    let across = cross(u, v);
    let volume = dot(n, across);
    let size_squared = dot(u, u) * dot(v, v) * dot(n, n);
    let is_frame = (volume * volume).simd_gt(FLAT * FLAT * size_squared)
        & volume.abs().simd_ge(f64x8::splat(f64::MIN_POSITIVE))
        & volume.is_finite();
    // Solve by Cramer's rule with one division for the three quotients.
    let scale = f64x8::ONE / (volume * s);
    let solved = [
        dot(cross(v, n), ray) * s * scale,
        dot(cross(n, u), ray) * s * scale,
        -dot(across, ray) * scale,
    ];
    let straight = [f64x8::ZERO, f64x8::ZERO, f64x8::ONE];
    std::array::from_fn(|i| is_frame.select(solved[i], straight[i]))
}

/// [`AttributePlanes::bend`] of eight triangles, of rays that are so many repeats longer for each that
/// they go farther; 0 where the normals at the corners are equal, or the
/// texture has no area.
fn bends(
    (normals, tangents, repeats): (&[Vectors; 3], &[[Vectors; 3]; 2], &[f64x8; 3]),
    tex_coords: &[Vectors; 3],
    (views, longer): (&[Vectors; 3], f64),
) -> [[f64x8; 2]; 3] {
    let growth = growth(tex_coords);
    let [alpha, beta, gamma] = [0, 1, 2].map(|axis| growth(views.map(|view| view[axis])));
    // What a repeat of the surface loses when it goes down one: its offsets, in the first corner's
    // frame, grow by that.
    let offset = |i: usize| normals[i].map(|n| n * repeats[i]);
    let frame = [tangents[0][0], tangents[1][0]];
    let offsets = [0, 1, 2]
        .map(|i| difference(offset(i), offset(0)))
        .map(|offset| view_in_texture_frame(offset, normals[0], (frame, repeats[0])));
    let lost = [0, 1].map(|axis| growth(offsets.map(|offset| offset[axis])));
    let down = (views[0][2] + views[1][2] + views[2][2]) * (1.0 / 3.0);
    let turn = |of: [f64x8; 2], axis: usize| {
        [0, 1].map(|i| {
            let own = if i == axis { longer } else { 0.0 };
            (of[i] - own + down * lost[axis][i]) * 0.5
        })
    };
    let bend = [gamma, turn(alpha, 0), turn(beta, 1)];
    let is_bent =
        bend.iter().flatten().fold(differ(normals), |is_bent, lanes| is_bent & lanes.is_finite());
    bend.map(|of| of.map(|lanes| is_bent.select(lanes, f64x8::ZERO)))
}

fn difference(a: Vectors, b: Vectors) -> Vectors {
    [0, 1, 2].map(|axis| a[axis] - b[axis])
}

#[inline(always)]
fn cross(a: Vectors, b: Vectors) -> Vectors {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
fn dot(a: Vectors, b: Vectors) -> f64x8 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
