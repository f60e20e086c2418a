//! The reliefs of a scene as rays go through them: where they end, and how deep they are.

use crate::geometry::Projection;
use crate::light::SurfacePoint;
use crate::raster::{Behind, Follow};
use crate::render::PreparedScene;
use crate::scene::Scene;
use crate::shell::{Met, ReliefHit, Shell, ViewRay, is_seen_from_behind};
use crate::simd::{PixelLanes, set_bits};
use glam::{DVec3, Vec3};

/// Follows rays behind the polygons of a frame.
#[derive(Clone, Copy)]
pub(crate) struct Outlines<'a> {
    scene: &'a Scene,
    prepared: &'a PreparedScene,
    projection: &'a Projection,
    shells: &'a [Option<Shell>],
}

impl<'a> Outlines<'a> {
    /// Of a scene with its projection; `None` where each ray meets the surface of the polygon that
    /// it sees.
    pub(crate) fn new(
        scene: &'a Scene,
        prepared: &'a PreparedScene,
        projection: &'a Projection,
    ) -> Option<Self> {
        let shells = prepared.shells(scene);
        let has_any = |shell: &Shell| scene.meshes.len() > 1 || shell.is_curved();
        let is_asked = shells.iter().flatten().any(has_any);
        is_asked.then_some(Self { scene, prepared, projection, shells })
    }

    /// Whether a mesh has a relief that is curved: followed rays then find what straight ones do not.
    pub(crate) fn is_curved(&self, mesh: u32) -> bool {
        self.shells[mesh as usize].as_ref().is_some_and(Shell::is_curved)
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
        let shell = self.shells[mesh as usize].as_ref();
        let mesh = &self.scene.meshes[mesh as usize];
        let field = || self.prepared.of_material(mesh.material, true)?.field();
        let Some((shell, field)) = shell.zip(field()) else { return Met::Polygon };
        let eye = self.scene.camera.eye.as_dvec3();
        let ray = ViewRay { eye, direction: self.projection.direction(place) };
        if PROBES {
            shell.probe(mesh, field, triangle, &ray)
        } else {
            shell.follow(mesh, field, triangle, &ray)
        }
    }
}

impl Follow for Outlines<'_> {
    fn has_relief(&self, mesh: u32) -> bool {
        self.shells[mesh as usize].is_some()
    }

    fn may_be_passed(&self, [mesh, triangle]: [u32; 2]) -> bool {
        self.shells[mesh as usize].as_ref().is_some_and(|shell| {
            let mesh = &self.scene.meshes[mesh as usize];
            shell.may_be_passed(mesh, triangle, self.scene.camera.eye)
        })
    }

    fn is_seen_from_behind(&self, [mesh, triangle]: [u32; 2]) -> bool {
        is_seen_from_behind(&self.scene.meshes[mesh as usize], triangle, self.scene.camera.eye)
    }

    fn deepest(&self, [mesh, triangle]: [u32; 2]) -> [Vec3; 3] {
        let eye = self.scene.camera.eye;
        let shell = self.shells[mesh as usize].as_ref();
        let mesh = &self.scene.meshes[mesh as usize];
        let corners = match shell {
            Some(shell) => shell.deepest(mesh, triangle, eye),
            None => mesh.triangles[triangle as usize].map(|i| mesh.positions[i as usize]),
        };
        corners.map(|corner| self.projection.view(corner))
    }

    fn probe(&self, triangle: [u32; 2], place: [f64; 2]) -> Option<f32> {
        let met = self.walk::<true>(triangle, place);
        if let Met::Relief(hit) = met { Some(hit.distance as f32) } else { None }
    }

    fn follow(&self, triangle: [u32; 2], place: [f64; 2]) -> Behind {
        match self.met(triangle, place) {
            Met::Relief(hit) => Behind::Surface(hit.distance as f32),
            Met::Nothing(distance) => Behind::Nothing(distance as f32),
            Met::Polygon => Behind::Surface(0.0),
        }
    }
}
