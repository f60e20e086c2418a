//! The reliefs of a scene as rays go through them: where they end, and how deep they are.

use crate::geometry::{Plane, Projection, ScreenBasis};
use crate::light::SurfacePoint;
use crate::relief::HeightField;
use crate::scene::{Eye, Mesh, Scene};
use crate::shell::{Course, Met, Outlined, Passable, ReliefHit, Shell, ViewRay, Width};
use crate::simd::{PixelLanes, set_bits};
use glam::{DVec3, Vec3};

/// Follows rays behind the polygons of a frame.
pub(crate) struct Outlines<'a> {
    scene: &'a Scene,
    projection: &'a Projection,
    eye: Eye,
    /// Of each mesh that has any.
    reliefs: Vec<Option<Relief<'a>>>,
    /// The same for light, of meshes that it may pass and that have no holes.
    outlined: Option<Outlined<'a>>,
}

/// Where rays may pass that may do so all over a triangle: see [`Follow::passable`](crate::raster::Follow::passable).
pub(super) const EVERYWHERE: Plane = [0.0, 0.0, -1.0];

/// The relief of a mesh.
pub(super) type Relief<'a> = (&'a Shell, &'a HeightField);

/// The meshes of a scene that throw the shadow of their relief, and not of their polygons.
pub(super) fn outlined<'a>(
    scene: &'a Scene,
    reliefs: &[Option<Relief<'a>>],
) -> Option<Outlined<'a>> {
    let is_passed = |mesh: &Mesh, (shell, _): &Relief| {
        // Triangles with holes are cut into pieces, which stop light as they are.
        shell.is_curved() && scene.cut_out(mesh).is_none()
    };
    let all = scene.meshes.iter().zip(reliefs);
    let passed = all.map(|(mesh, relief)| relief.filter(|relief| is_passed(mesh, relief)));
    Outlined::new(&scene.meshes, passed.collect())
}

impl<'a> Outlines<'a> {
    /// Of a scene with its projection and the reliefs of its meshes; `None` where each ray meets the
    /// surface of the polygon that it sees.
    pub(super) fn new(
        scene: &'a Scene,
        projection: &'a Projection,
        reliefs: Vec<Option<Relief<'a>>>,
    ) -> Option<Self> {
        let is_asked = |(mesh, relief): (&Mesh, &Option<Relief>)| {
            let is_curved = |(shell, _): &Relief| shell.is_curved();
            // Holes are where rays hit the relief.
            let is_cut = scene.cut_out(mesh).is_some();
            relief.as_ref().is_some_and(|relief| is_cut || is_curved(relief))
        };
        let has_any = reliefs.iter().flatten().next().is_some() && scene.meshes.len() > 1
            || scene.meshes.iter().zip(&reliefs).any(is_asked);
        let eye = scene.camera.viewpoint();
        has_any.then(|| {
            let outlined = outlined(scene, &reliefs);
            Self { scene, projection, eye, reliefs, outlined }
        })
    }

    /// The meshes that throw the shadow of their relief.
    pub(crate) fn outlined(&self) -> Option<&Outlined<'a>> {
        self.outlined.as_ref()
    }

    /// Whether a mesh has a relief that is curved: followed rays then find what straight ones do not.
    pub(crate) fn is_curved(&self, mesh: u32) -> bool {
        self.reliefs[mesh as usize].is_some_and(|(shell, _)| shell.is_curved())
    }

    /// The relief that rays through places of the screen hit behind a triangle of a mesh with relief,
    /// of those asked for.
    pub(crate) fn hits(
        &self,
        triangle: [u32; 2],
        [x, y]: [PixelLanes; 2],
        asked: u8,
    ) -> [Option<ReliefHit>; 8] {
        let mut hits = [None; 8];
        for lane in set_bits(asked) {
            let place = [x, y].map(|lanes| f64::from(lanes.as_array()[lane]));
            if let Met::Relief(hit) = self.met(triangle, place) {
                hits[lane] = Some(hit);
            }
        }
        hits
    }

    /// The polygon above a hit.
    pub(crate) fn point(&self, mesh: u32, hit: &ReliefHit) -> SurfacePoint {
        let mesh = &self.scene.meshes[mesh as usize];
        let corners = mesh.triangles[hit.triangle as usize].map(|i| i as usize);
        let mean = |of: &dyn Fn(usize) -> Vec3| {
            corners
                .iter()
                .zip(hit.shares)
                .fold(DVec3::ZERO, |sum, (i, share)| sum + of(*i).as_dvec3() * share)
                .as_vec3()
        };
        SurfacePoint {
            position: mean(&|i| mesh.positions[i]),
            normal: mean(&|i| mesh.normals[i]),
            tangents: [0, 1].map(|axis| mean(&|i| mesh.tangents[i][axis])),
            is_back: hit.is_back,
        }
    }

    /// What a ray through a place of the screen meets behind a triangle: without relief its polygon,
    /// however near.
    pub(crate) fn met(&self, triangle: [u32; 2], place: [f64; 2]) -> Met {
        let [mesh, triangle] = triangle;
        let Some((shell, field)) = self.reliefs[mesh as usize] else { return Met::Polygon };
        shell.follow(&self.scene.meshes[mesh as usize], field, triangle, &self.ray(place))
    }

    /// What a triangle tells of the course of the ray through a place of the screen.
    pub(super) fn course(&self, [mesh, triangle]: [u32; 2], place: [f64; 2]) -> Course {
        self.reliefs[mesh as usize].map_or(Course::Told, |(shell, _)| {
            shell.course(&self.scene.meshes[mesh as usize], triangle, &self.ray(place))
        })
    }

    fn ray(&self, place: [f64; 2]) -> ViewRay {
        let (from, direction) = (self.projection.origin(place), self.projection.direction(place));
        ViewRay { from, direction }
    }

    /// Whether a mesh has relief.
    pub(super) fn has_relief(&self, mesh: u32) -> bool {
        self.reliefs[mesh as usize].is_some()
    }

    /// See [`Follow::passable`](crate::raster::Follow::passable).
    pub(super) fn passable(&self, [mesh, triangle]: [u32; 2]) -> Option<Plane> {
        let (shell, _) = self.reliefs[mesh as usize]?;
        let mesh = &self.scene.meshes[mesh as usize];
        let Passable { facing, cosine } = shell.passable(mesh, triangle, self.eye)?;
        let corners = mesh.triangles[triangle as usize].map(|i| mesh.positions[i as usize]);
        let view = corners.map(|corner| self.projection.view(corner));
        if view.iter().any(|corner| corner.z < self.projection.near) {
            return Some(EVERYWHERE);
        }
        // The product over the distance along the view is the cosine times the length of the ray there
        // that goes 1 along the view: the longest is at a corner.
        let lengths = corners.map(|corner| self.eye.seen_from(corner).length());
        let longest = (0..3).fold(1.0_f32, |longest, i| {
            if self.projection.is_orthographic() {
                1.0
            } else {
                longest.max(lengths[i] / view[i].z)
            }
        });
        let view = view.map(|corner| corner.as_dvec3().to_array());
        let basis = ScreenBasis::new(view, &self.projection.lens);
        let [a, b, c] = basis.plane(facing.map(f64::from));
        Some([a, b, c - cosine * longest])
    }

    /// See [`Follow::deepest`](crate::raster::Follow::deepest).
    pub(super) fn deepest(&self, [mesh, triangle]: [u32; 2]) -> Option<[Vec3; 3]> {
        let (shell, _) = self.reliefs[mesh as usize]?;
        let mesh = &self.scene.meshes[mesh as usize];
        let corners = shell.deepest(mesh, triangle, self.eye);
        Some(corners.map(|corner| self.projection.view(corner)))
    }

    /// See [`Follow::probe`](crate::raster::Follow::probe).
    pub(super) fn probe(
        &self,
        [mesh, triangle]: [u32; 2],
        place: [f64; 2],
        around: f64,
    ) -> Option<f32> {
        let (shell, field) = self.reliefs[mesh as usize]?;
        let [at_eye, per_distance] = self.projection.pixel_size().map(|size| size * around);
        let with = (&self.ray(place), Width { at_eye, per_distance });
        let met = shell.probe(&self.scene.meshes[mesh as usize], field, triangle, with);
        if let Met::Relief(hit) = met { Some(hit.distance as f32) } else { None }
    }
}
