//! The tree of nodes to places in the world: of meshes, cameras and lights.

use super::document::{Document, Reasoned};
use crate::scene::{Camera, Light};
use glam::{DAffine3, DMat4, DQuat, DVec3, Vec3};
use gltf::json::camera::{Orthographic, Perspective};
use gltf::json::extensions::scene::khr_lights_punctual::{Light as PunctualLight, Type};
use gltf::json::validation::Checked;
use gltf::json::{Index, Mesh, Node};

/// A mesh somewhere in the world.
pub(super) struct Instance {
    pub(super) mesh: Index<Mesh>,
    pub(super) node: Index<Node>,
    pub(super) to_world: DAffine3,
}

/// What the nodes of a scene place in the world.
#[derive(Default)]
pub(super) struct Placed {
    pub(super) instances: Vec<Instance>,
    /// The first camera that can be drawn with.
    pub(super) camera: Option<Camera>,
    pub(super) lights: Vec<Light>,
    /// Of each node, where the scene has it.
    pub(super) to_world: Vec<Option<DAffine3>>,
}

impl Document {
    /// Walks the default scene, or the first; without scenes, all nodes that are no children.
    ///
    /// # Errors
    /// Names a node that does not exist, that is reached twice or that has no valid place.
    pub(super) fn place(&mut self) -> Reasoned<Placed> {
        let mut placed =
            Placed { to_world: vec![None; self.root.nodes.len()], ..Placed::default() };
        // In the order of the file: the last is taken first.
        let mut left: Vec<_> =
            self.top_nodes()?.into_iter().map(|node| (node, DAffine3::IDENTITY)).collect();
        left.reverse();
        while let Some((index, to_parent)) = left.pop() {
            let node =
                self.root.get(index).ok_or_else(|| format!("node {index} does not exist"))?;
            let to_world =
                to_parent * local(node).map_err(|reason| format!("node {index} {reason}"))?;
            if !to_world.is_finite() {
                return Err(format!("node {index} is not at a finite place"));
            }
            if placed.to_world[index.value()].replace(to_world).is_some() {
                return Err(format!("node {index} is reached twice: nodes must be a tree"));
            }
            left.extend(node.children.iter().flatten().rev().map(|child| (*child, to_world)));
            if let Some(mesh) = node.mesh {
                placed.instances.push(Instance { mesh, node: index, to_world });
            }
            let light = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
            let (camera, light) = (node.camera, light.map(|light| light.light));
            if let Some(camera) = camera.filter(|_| placed.camera.is_none()) {
                placed.camera = self.camera(camera, &to_world)?;
            }
            if let Some(light) = light {
                placed.lights.extend(self.light(light, &to_world)?);
            }
        }
        Ok(placed)
    }

    fn top_nodes(&mut self) -> Reasoned<Vec<Index<Node>>> {
        let root = &self.root;
        let scene = match root.scene {
            Some(index) => Some(root.get(index).ok_or(format!("scene {index} does not exist"))?),
            None => root.scenes.first(),
        };
        let num_scenes = root.scenes.len();
        let nodes = scene.map(|scene| scene.nodes.clone()).unwrap_or_else(|| {
            let children = root.nodes.iter().flat_map(|node| node.children.iter().flatten());
            let mut is_child = vec![false; root.nodes.len()];
            children.for_each(|child| {
                is_child.get_mut(child.value()).into_iter().for_each(|is| *is = true);
            });
            (0..).zip(is_child).filter(|(_, is)| !is).map(|(i, _)| Index::new(i)).collect()
        });
        if num_scenes > 1 {
            self.warn(format_args!("has {num_scenes} scenes; one is drawn"));
        }
        Ok(nodes)
    }

    fn camera(
        &mut self,
        index: Index<gltf::json::Camera>,
        to_world: &DAffine3,
    ) -> Reasoned<Option<Camera>> {
        let camera =
            self.root.get(index).ok_or_else(|| format!("camera {index} does not exist"))?;
        let found = match (&camera.perspective, &camera.orthographic) {
            (Some(lens), _) => Some(perspective(lens)),
            (None, Some(lens)) => Some(orthographic(lens)),
            (None, None) => None,
        };
        let placed = found.map(|camera| placed(camera, to_world));
        let found = placed.filter(|camera| camera.validate().is_ok());
        if found.is_none() {
            self.warn(format_args!("camera {index} is not valid; not used"));
        }
        Ok(found)
    }

    fn light(
        &mut self,
        index: Index<PunctualLight>,
        to_world: &DAffine3,
    ) -> Reasoned<Option<Light>> {
        let light = self.root.get(index).ok_or_else(|| format!("light {index} does not exist"))?;
        // A white surface under pi lux, or at a metre from pi candela, is drawn white.
        let scale = light.intensity * std::f32::consts::FRAC_1_PI;
        let intensity = Vec3::from(light.color) * scale;
        let intensity = intensity.clamp(Vec3::ZERO, Vec3::splat(1e6));
        let position = to_world.translation.as_vec3();
        Ok(match light.type_ {
            Checked::Valid(Type::Directional) => {
                Some(Light::sun(unit(to_world.matrix3.z_axis), intensity))
            }
            Checked::Valid(Type::Point) => Some(Light::Point { position, intensity }),
            Checked::Valid(Type::Spot) => {
                self.warn(format_args!("light {index} is a spot; shines to all sides"));
                Some(Light::Point { position, intensity })
            }
            Checked::Invalid => {
                self.warn(format_args!("light {index} is of an unknown kind; left out"));
                None
            }
        })
    }
}

/// A node's place in its parent.
fn local(node: &Node) -> Result<DAffine3, &'static str> {
    if let Some(columns) = node.matrix {
        let matrix = DMat4::from_cols_array(&columns.map(f64::from));
        if matrix.row(3) != glam::DVec4::W {
            return Err("has a matrix that is not affine");
        }
        return Ok(DAffine3::from_mat4(matrix));
    }
    let vector = |v: [f32; 3]| DVec3::from(v.map(f64::from));
    let scale = node.scale.map_or(DVec3::ONE, vector);
    let translation = node.translation.map_or(DVec3::ZERO, vector);
    let rotation = node.rotation.map_or(DQuat::IDENTITY, |q| DQuat::from_array(q.0.map(f64::from)));
    if rotation.length_squared().is_nan() || rotation.length_squared() < 1e-12 {
        return Err("has a rotation that is none");
    }
    Ok(DAffine3::from_scale_rotation_translation(scale, rotation.normalize(), translation))
}

fn perspective(lens: &Perspective) -> Camera {
    Camera { fov_degrees: lens.yfov.to_degrees(), near: lens.znear, ..Camera::default() }
}

/// Its width is the frame's, in square pixels, as that of a perspective is.
fn orthographic(lens: &Orthographic) -> Camera {
    // What is nearest may be at the eye itself.
    let near = lens.znear.max(lens.zfar * 1e-6);
    // Where a direction is mirrored, its magnification is below 0.
    Camera { orthographic: Some(2.0 * lens.ymag.abs()), near, ..Camera::default() }
}

/// A camera that looks along -z of its node, with y up.
fn placed(camera: Camera, to_world: &DAffine3) -> Camera {
    let [eye, forward] = [to_world.translation.as_vec3(), -unit(to_world.matrix3.z_axis)];
    // As far from the eye as that from the origin: nearer, rounding would turn the view.
    let target = eye + forward * eye.abs().max_element().max(1.0);
    Camera { eye, target, up: unit(to_world.matrix3.y_axis), ..camera }
}

fn unit(axis: DVec3) -> Vec3 {
    axis.try_normalize().map_or(Vec3::Z, |axis| axis.as_vec3())
}
