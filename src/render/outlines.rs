//! The reliefs of a scene as rays go through them: where they end, and how deep they are.

use crate::geometry::Projection;
use crate::light::SurfacePoint;
use crate::raster::Behind;
use crate::relief::HeightField;
use crate::scene::{Eye, Scene};
use crate::shell::{Met, ReliefHit, Shell, ViewRay};
use crate::simd::{PixelLanes, set_bits};
use glam::{DVec3, Vec3};

/// Follows rays behind the polygons of a frame.
pub(crate) struct Outlines<'a> {
    scene: &'a Scene,
    projection: &'a Projection,
    eye: Eye,
    /// Of each mesh that has any.
    reliefs: Vec<Option<Relief<'a>>>,
}

/// The relief of a mesh.
pub(super) type Relief<'a> = (&'a Shell, &'a HeightField);

impl<'a> Outlines<'a> {
    /// Of a scene with its projection and the reliefs of its meshes; `None` where each ray meets the
    /// surface of the polygon that it sees.
    pub(super) fn new(
        scene: &'a Scene,
        projection: &'a Projection,
        reliefs: Vec<Option<Relief<'a>>>,
    ) -> Option<Self> {
        let is_asked = |(shell, _): &Relief| scene.meshes.len() > 1 || shell.is_curved();
        let has_any = reliefs.iter().flatten().any(is_asked);
        let eye = scene.camera.viewpoint();
        has_any.then_some(Self { scene, projection, eye, reliefs })
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
        }
    }

    /// What a ray through a place of the screen meets behind a triangle: without relief its polygon,
    /// however near.
    pub(crate) fn met(&self, triangle: [u32; 2], place: [f64; 2]) -> Met {
        self.walk::<false>(triangle, place)
    }

    fn walk<const PROBES: bool>(&self, [mesh, triangle]: [u32; 2], place: [f64; 2]) -> Met {
        let Some((shell, field)) = self.reliefs[mesh as usize] else { return Met::Polygon };
        let mesh = &self.scene.meshes[mesh as usize];
        let (from, direction) = (self.projection.origin(place), self.projection.direction(place));
        let ray = ViewRay { from, direction };
        if PROBES {
            shell.probe(mesh, field, triangle, &ray)
        } else {
            shell.follow(mesh, field, triangle, &ray)
        }
    }

    /// Whether a mesh has relief.
    pub(super) fn has_relief(&self, mesh: u32) -> bool {
        self.reliefs[mesh as usize].is_some()
    }

    /// Whether a ray from the eye may pass the relief of a triangle.
    pub(super) fn may_be_passed(&self, [mesh, triangle]: [u32; 2]) -> bool {
        self.reliefs[mesh as usize].is_some_and(|(shell, _)| {
            let mesh = &self.scene.meshes[mesh as usize];
            shell.may_be_passed(mesh, triangle, self.eye)
        })
    }

    /// See [`Follow::deepest`](crate::raster::Follow::deepest).
    pub(super) fn deepest(&self, [mesh, triangle]: [u32; 2]) -> Option<[Vec3; 3]> {
        let (shell, _) = self.reliefs[mesh as usize]?;
        let mesh = &self.scene.meshes[mesh as usize];
        let corners = shell.deepest(mesh, triangle, self.eye);
        Some(corners.map(|corner| self.projection.view(corner)))
    }

    /// See [`Follow::probe`](crate::raster::Follow::probe).
    pub(super) fn probe(&self, triangle: [u32; 2], place: [f64; 2]) -> Option<f32> {
        let met = self.walk::<true>(triangle, place);
        if let Met::Relief(hit) = met { Some(hit.distance as f32) } else { None }
    }

    /// What the ray through a place of the screen meets behind a triangle.
    pub(super) fn follow(&self, triangle: [u32; 2], place: [f64; 2]) -> Behind {
        match self.met(triangle, place) {
            Met::Relief(hit) => Behind::Surface(hit.distance as f32),
            Met::Nothing(distance) => Behind::Nothing(distance as f32),
            Met::Polygon => Behind::Surface(0.0),
        }
    }
}
