//! Draws frames on threads of its own, so that the window answers while a frame is drawn. Only the latest wish counts.

use basrelief::{Camera, Filter, Frame, Renderer, Scene, Settings};
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Instant;

/// What is to be drawn.
pub(crate) enum Wish {
    /// A frame, or the halves of one for a split screen.
    Draw { camera: Camera, settings: Vec<Settings> },
    /// Frames of another scene from now on.
    Scene(Box<Scene>),
}

/// What was drawn.
pub(crate) struct Drawn {
    pub(crate) frames: Vec<Frame>,
    /// Milliseconds that drawing took, tables not counted.
    pub(crate) ms: f64,
}

/// What comes back: frames, or why there are none.
pub(crate) type Answer = Result<Drawn, String>;

/// The drawing thread.
pub(crate) struct Worker {
    wishes: Sender<Wish>,
}

impl Worker {
    /// Starts the thread; `answer` is called on it.
    pub(crate) fn start(
        scene: Scene,
        num_threads: usize,
        answer: impl Fn(Answer) + Send + 'static,
    ) -> Result<Self, String> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(num_threads).build().map_err(|e| e.to_string())?;
        let (wishes, inbox) = channel();
        std::thread::spawn(move || Painter::new(scene, pool).serve(&inbox, &answer));
        Ok(Self { wishes })
    }

    /// Says what is to be drawn. One frame is drawn at a time.
    pub(crate) fn wish(&self, wish: Wish) {
        // The thread lives as long as there are wishes.
        let _ = self.wishes.send(wish);
    }
}

/// Renderers of a scene, one for each filter, since tables of one are dropped when it becomes another.
struct Painter {
    pool: rayon::ThreadPool,
    scene: Scene,
    renderers: HashMap<Filter, Renderer>,
}

impl Painter {
    fn new(scene: Scene, pool: rayon::ThreadPool) -> Self {
        Self { pool, scene, renderers: HashMap::new() }
    }

    fn serve(&mut self, wishes: &Receiver<Wish>, answer: &dyn Fn(Answer)) {
        while let Ok(wish) = wishes.recv() {
            match wish {
                Wish::Draw { camera, settings } => {
                    let Self { pool, scene, renderers } = self;
                    answer(pool.install(|| draw(scene, renderers, camera, &settings)).map_err(|e| e.to_string()));
                }
                Wish::Scene(scene) => {
                    self.scene = *scene;
                    self.renderers.clear();
                }
            }
        }
    }
}

fn draw(
    scene: &Scene,
    renderers: &mut HashMap<Filter, Renderer>,
    camera: Camera,
    settings: &[Settings],
) -> Result<Drawn, basrelief::Error> {
    let mut drawn = Drawn { frames: Vec::new(), ms: 0.0 };
    for settings in settings {
        let renderer = match renderers.entry(settings.filter) {
            Entry::Occupied(entry) => entry.into_mut(),
            Entry::Vacant(entry) => entry.insert(Renderer::new(scene.clone(), settings.clone())?),
        };
        if renderer.settings() != settings {
            renderer.set_settings(settings.clone())?;
        }
        renderer.set_camera(camera)?;
        let start = Instant::now();
        drawn.frames.push(renderer.render());
        drawn.ms += start.elapsed().as_secs_f64() * 1e3;
    }
    Ok(drawn)
}
