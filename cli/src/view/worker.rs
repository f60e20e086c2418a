//! Draws frames on threads of its own, so that the window answers while a frame is drawn. Only the
//! latest wish counts.

use basrelief::{Camera, Filter, Frame, Renderer, Scene, Settings};
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
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(num_threads)
            .build()
            .map_err(|e| e.to_string())?;
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

/// Draws what is wished for, scene after scene.
struct Painter {
    pool: rayon::ThreadPool,
    /// The scene's renderer, or why there is none.
    renderer: Result<Renderer, String>,
}

impl Painter {
    fn new(scene: Scene, pool: rayon::ThreadPool) -> Self {
        Self { renderer: renderer(scene, &pool), pool }
    }

    fn serve(&mut self, wishes: &Receiver<Wish>, answer: &dyn Fn(Answer)) {
        while let Ok(wish) = wishes.recv() {
            match wish {
                Wish::Draw { camera, settings } => answer(self.draw(camera, settings)),
                Wish::Scene(scene) => self.renderer = renderer(*scene, &self.pool),
            }
        }
    }

    fn draw(&mut self, camera: Camera, settings: Vec<Settings>) -> Answer {
        let Self { pool, renderer } = self;
        let renderer = renderer.as_mut().map_err(|reason| reason.clone())?;
        pool.install(|| draw(renderer, camera, settings)).map_err(|e| e.to_string())
    }
}

/// A renderer of the scene. It begins with a filter without tables: those are made for what is
/// wished for first.
fn renderer(scene: Scene, pool: &rayon::ThreadPool) -> Result<Renderer, String> {
    let settings = Settings { filter: Filter::Nearest, ..Settings::default() };
    pool.install(|| Renderer::new(scene, settings)).map_err(|e| e.to_string())
}

fn draw(
    renderer: &mut Renderer,
    camera: Camera,
    settings: Vec<Settings>,
) -> Result<Drawn, basrelief::Error> {
    renderer.set_camera(camera)?;
    let mut drawn = Drawn { frames: Vec::new(), ms: 0.0 };
    for settings in settings {
        renderer.set_settings(settings)?;
        let start = Instant::now();
        let mut frame = renderer.render();
        frame.apply_tone(renderer.settings().tone);
        drawn.frames.push(frame);
        drawn.ms += start.elapsed().as_secs_f64() * 1e3;
    }
    Ok(drawn)
}

#[cfg(test)]
mod tests {
    use super::*;
    use basrelief::{Region, render, scene};

    #[test]
    fn one_renderer_draws_halves_by_two_filters_and_then_another_scene() {
        let (answers, outbox) = channel();
        let answer = move |answer| answers.send(answer).unwrap();
        let worker = Worker::start(scene::builtin(), 2, answer).unwrap();
        let half = |filter, x| {
            let region = Some(Region { x, y: 0, width: 16, height: 18 });
            Settings { width: 32, height: 18, region, filter, ..Settings::default() }
        };
        let settings = vec![half(Filter::default(), 0), half(Filter::Bilinear, 16)];
        let mut other = scene::builtin();
        other.background = [1.0, 0.0, 0.0, 1.0];
        for scene in [scene::builtin(), other] {
            let camera = scene.camera;
            worker.wish(Wish::Scene(Box::new(scene.clone())));
            // Once more with all tables made.
            for _ in 0..2 {
                worker.wish(Wish::Draw { camera, settings: settings.clone() });
                let drawn = outbox.recv().unwrap().unwrap();
                let expected =
                    settings.iter().map(|half| render(scene.clone(), half.clone()).unwrap());
                assert!(drawn.frames.into_iter().eq(expected));
            }
        }
    }

    #[test]
    fn a_scene_that_cannot_be_drawn_is_answered_with_the_reason() {
        let (answers, outbox) = channel();
        let wrong = Scene { background: [f32::NAN; 4], ..scene::builtin() };
        let worker =
            Worker::start(wrong, 1, move |answer: Answer| answers.send(answer).unwrap()).unwrap();
        let camera = scene::builtin().camera;
        worker.wish(Wish::Draw { camera, settings: vec![Settings::default()] });
        let reason = outbox.recv().unwrap().err().unwrap();
        assert!(reason.contains("background"), "{reason}");
    }
}
