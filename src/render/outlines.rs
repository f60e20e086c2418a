//! The reliefs of a scene as rays go through them: where they end, and how deep they are.

use crate::geometry::Projection;
use crate::raster::{Behind, Follow};
use crate::render::PreparedScene;
use crate::scene::Scene;
use crate::shell::{Met, Shell, ViewRay, is_seen_from_behind};
use glam::Vec3;

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
        let has_any = |shell: &Shell| scene.meshes.len() > 1 || shell.has_outline();
        let is_asked = shells.iter().flatten().any(has_any);
        is_asked.then_some(Self { scene, prepared, projection, shells })
    }

    /// What a ray through a place of the screen meets behind a triangle of a mesh with relief.
    pub(crate) fn met(&self, [mesh, triangle]: [u32; 2], place: [f64; 2]) -> Option<Met> {
        let shell = self.shells[mesh as usize].as_ref()?;
        let mesh = &self.scene.meshes[mesh as usize];
        let field = self.prepared.of_material(mesh.material, true)?.field()?;
        let eye = self.scene.camera.eye.as_dvec3();
        let ray = ViewRay { eye, direction: self.projection.direction(place) };
        Some(shell.follow(mesh, field, triangle, &ray))
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

    fn follow(&self, triangle: [u32; 2], place: [f64; 2]) -> Behind {
        match self.met(triangle, place) {
            Some(Met::Relief(hit)) => Behind::Surface(hit.distance as f32),
            Some(Met::Nothing(distance)) => Behind::Nothing(distance as f32),
            // Without relief the polygon is the surface, however near.
            None => Behind::Surface(0.0),
        }
    }
}
