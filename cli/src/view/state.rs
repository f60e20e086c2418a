//! What the viewer shows and how keys and mouse change it. Knows nothing of windows.

use crate::options::choices::{FILTERS, word};
use crate::options::filter::FilterOptions;
use crate::options::viewer::KEYS;
use crate::pictures::draw::Canvas;
use crate::view::orbit::Orbit;
use crate::view::overlay;
use crate::view::pace::Pace;
use crate::view::worker::{Answer, Wish};
use basrelief::inspect;
use basrelief::load::{self, LoadOptions};
use basrelief::{Ewa, Filter, Frame, Lighting, Region, Scene, Settings};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// How long nothing must move before a frame is refined.
const STILL: Duration = Duration::from_millis(150);

/// The viewer.
pub(crate) struct Viewer {
    scene: Scene,
    settings: Settings,
    /// What each filter is told when it is chosen.
    options: FilterOptions,
    path: Option<PathBuf>,
    load_options: LoadOptions,
    orbit: Orbit,
    /// Filter of the whole window or its left half, and of the right half if it is split.
    filters: [Filter; 2],
    is_split: bool,
    is_full_size: bool,
    pace: Pace,
    /// How wide pixels are in the frame under way.
    under_way: Option<u32>,
    /// Whether what is shown is no longer what should be, and how coarse it is.
    is_stale: bool,
    shown: Vec<Frame>,
    shown_scale: u32,
    ms: f64,
    num_drawn: u32,
    moved: Instant,
    inspected: Option<Canvas>,
    message: Option<String>,
    shows_help: bool,
}

/// What a key or button means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Act {
    /// Around the middle, in radians: sideways and up.
    Turn(f32, f32),
    /// Parts of the window's height: right and up.
    Pan(f32, f32),
    /// Steps nearer.
    Zoom(f32),
    /// The filter of that number, of the right half or of the whole window.
    Filter {
        number: usize,
        is_right: bool,
    },
    Split,
    Light,
    Home,
    Help,
    /// Closes what lies above the picture.
    Close,
}

impl Viewer {
    pub(crate) fn new(
        scene: Scene,
        settings: Settings,
        options: FilterOptions,
        path: Option<PathBuf>,
        load_options: LoadOptions,
    ) -> Self {
        let orbit = Orbit::new(scene.camera);
        Self {
            filters: [settings.filter, options.apply(Filter::Ewa(Ewa::default()))],
            scene,
            settings,
            options,
            path,
            load_options,
            orbit,
            is_split: false,
            is_full_size: false,
            pace: Pace::default(),
            under_way: None,
            is_stale: true,
            shown: Vec::new(),
            shown_scale: 1,
            ms: 0.0,
            num_drawn: 0,
            moved: Instant::now(),
            inspected: None,
            message: None,
            shows_help: false,
        }
    }

    pub(crate) fn split_with(&mut self, filter: Option<Filter>) {
        self.is_split = filter.is_some();
        self.filters[1] = filter.map_or(self.filters[1], |filter| self.options.apply(filter));
    }

    pub(crate) fn keep_full_size(&mut self, is_full_size: bool) {
        self.is_full_size = is_full_size;
    }

    /// The scene, for the drawing thread.
    pub(crate) fn scene(&self) -> Scene {
        self.scene.clone()
    }

    /// Width and height of the window in pixels.
    pub(crate) fn size(&self) -> [u32; 2] {
        [self.settings.width, self.settings.height]
    }

    pub(crate) fn num_drawn(&self) -> u32 {
        self.num_drawn
    }

    pub(crate) fn resize(&mut self, [width, height]: [u32; 2]) {
        (self.settings.width, self.settings.height) =
            (width.clamp(1, 32768), height.clamp(1, 32768));
        self.pace.forget();
        self.change();
    }

    /// Does what a key or button means. Whether the viewer goes on.
    pub(crate) fn act(&mut self, act: Act) -> bool {
        match act {
            Act::Turn(yaw, pitch) => self.orbit.turn(yaw, pitch),
            Act::Pan(right, up) => self.orbit.pan(right, up),
            Act::Zoom(steps) => self.orbit.zoom(steps),
            Act::Home => self.orbit = Orbit::new(self.scene.camera),
            Act::Filter { number, is_right } => self.choose(number, is_right),
            Act::Split => {
                self.is_split = !self.is_split;
                if self.filters[0] == self.filters[1] {
                    let others = [Filter::default(), Filter::Ewa(Ewa::default())]
                        .map(|f| self.options.apply(f));
                    let other = others.into_iter().find(|filter| *filter != self.filters[0]);
                    self.filters[1] = other.unwrap_or(self.filters[1]);
                }
                self.pace.forget();
            }
            Act::Light => {
                let is_lit = self.settings.lighting == Lighting::Lit;
                self.settings.lighting = if is_lit { Lighting::Unlit } else { Lighting::Lit };
                self.pace.forget();
            }
            Act::Help => {
                self.shows_help = !self.shows_help;
                return true;
            }
            Act::Close => {
                let is_open = self.shows_help || self.inspected.is_some() || self.message.is_some();
                (self.shows_help, self.inspected, self.message) = (false, None, None);
                return is_open;
            }
        }
        self.change();
        true
    }

    fn choose(&mut self, number: usize, is_right: bool) {
        if let Some(&(_, filter, _)) = FILTERS.get(number) {
            self.filters[usize::from(is_right)] = self.options.apply(filter);
            self.is_split |= is_right;
            self.pace.forget();
        }
    }

    fn change(&mut self) {
        self.is_stale = true;
        self.inspected = None;
        self.moved = Instant::now();
    }

    /// Opens the inspector on a pixel of the window.
    pub(crate) fn inspect(&mut self, [x, y]: [u32; 2]) {
        let [width, _] = self.size();
        let scene = Scene { camera: self.orbit.camera(), ..self.scene.clone() };
        let side = usize::from(self.is_split && x >= width / 2);
        let filter = self.options.inspected(self.filters[side]);
        let settings = Settings { filter, ..self.settings.clone() };
        match inspect::pixel(&scene, &settings, [x, y]) {
            Ok(seen) => self.inspected = Some(overlay::inspector(&seen, self.size())),
            Err(e) => self.message = Some(e.to_string()),
        }
    }

    /// Loads a file that was dropped: a scene, or an image as a map of the scene shown. What the
    /// drawing thread must know.
    pub(crate) fn load(&mut self, dropped: &Path) -> Option<Wish> {
        let mut options = self.load_options.clone();
        let path = match kind_of(dropped) {
            Kind::Scene => dropped.to_owned(),
            kind => {
                let Some(path) = self.path.clone() else {
                    self.message = Some("an image is a map of a model: drop one first".into());
                    return None;
                };
                let map = match kind {
                    Kind::Height => &mut options.all.height,
                    Kind::Normal => &mut options.all.normal,
                    _ => &mut options.all.albedo,
                };
                *map = Some(dropped.to_owned());
                path
            }
        };
        match load::load(&path, &options)
            .and_then(|loaded| loaded.scene.validate().map(|()| loaded.scene))
        {
            Ok(scene) => {
                if kind_of(dropped) == Kind::Scene {
                    self.orbit = Orbit::new(scene.camera);
                }
                (self.scene, self.path, self.load_options) = (scene, Some(path), options);
                self.pace.forget();
                self.change();
                Some(Wish::Scene(Box::new(self.scene())))
            }
            Err(e) => {
                self.message = Some(e.to_string());
                None
            }
        }
    }

    /// The next frame to draw, if one is due; or when to ask again.
    pub(crate) fn next(&mut self, now: Instant) -> Result<Wish, Option<Instant>> {
        if self.under_way.is_some() {
            return Err(None);
        }
        let still_at = self.moved + STILL;
        let scale = match () {
            () if self.is_full_size && self.is_stale => 1,
            () if self.is_stale => self.pace.moving_scale(),
            () if self.shown_scale == 1 => return Err(None),
            () if now < still_at => return Err(Some(still_at)),
            () => 1,
        };
        (self.under_way, self.is_stale) = (Some(scale), false);
        Ok(Wish::Draw { camera: self.orbit.camera(), settings: self.settings_at(scale) })
    }

    fn settings_at(&self, scale: u32) -> Vec<Settings> {
        let [width, height] = self.size().map(|side| side.div_ceil(scale));
        let whole = Settings { width, height, ..self.settings.clone() };
        if !self.is_split || width < 2 {
            return vec![Settings { filter: self.filters[0], ..whole }];
        }
        let half = width / 2;
        let halves =
            [(0, half), (half, width - half)].map(|(x, width)| Region { x, y: 0, width, height });
        let settings =
            |(filter, region)| Settings { filter, region: Some(region), ..whole.clone() };
        self.filters.into_iter().zip(halves).map(settings).collect()
    }

    /// Takes what the drawing thread gives.
    pub(crate) fn drawn(&mut self, answer: Answer) {
        let scale = self.under_way.take().unwrap_or(1);
        match answer {
            Ok(drawn) => {
                self.pace.learn(scale, drawn.ms);
                (self.shown, self.shown_scale, self.ms) = (drawn.frames, scale, drawn.ms);
                self.num_drawn += 1;
            }
            Err(message) => (self.message, self.shown_scale) = (Some(message), 1),
        }
    }

    /// How wide the pixels of the frame shown are.
    pub(crate) fn shown_scale(&self) -> u32 {
        self.shown_scale
    }

    /// The window's content.
    pub(crate) fn picture(&self) -> Canvas {
        let mut canvas = overlay::frames(&self.shown, self.size());
        let names = self.filters.each_ref().map(word);
        let names = &names[..if self.is_split { 2 } else { 1 }];
        overlay::status(&mut canvas, names, &self.timing());
        if let Some(inspected) = &self.inspected {
            overlay::beside(&mut canvas, inspected);
        }
        if self.shows_help {
            overlay::lines(&mut canvas, KEYS);
        } else if let Some(message) = &self.message {
            overlay::lines(&mut canvas, message);
        }
        canvas
    }

    fn timing(&self) -> String {
        let Some(frame) = self.shown.first() else { return "drawing the first frame".into() };
        let width: u32 = self.shown.iter().map(|frame| frame.width).sum();
        let size = format!("{width}x{}", frame.height);
        format!("{size}  {:.0} ms, {:.0} frames/s  H: help", self.ms, 1e3 / self.ms.max(1e-3))
    }
}

/// What a dropped file is, by its name.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Kind {
    Scene,
    Height,
    Normal,
    Albedo,
}

fn kind_of(path: &Path) -> Kind {
    let name =
        path.file_name().map(|name| name.to_string_lossy().to_lowercase()).unwrap_or_default();
    let has = |words: &[&str]| words.iter().any(|word| name.contains(word));
    match () {
        () if [".obj", ".gltf", ".glb"].iter().any(|end| name.ends_with(end)) => Kind::Scene,
        () if has(&["normal", "nrm"]) => Kind::Normal,
        () if has(&["height", "disp", "depth", "bump"]) => Kind::Height,
        () => Kind::Albedo,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::worker::Drawn;
    use basrelief::scene;

    fn viewer() -> Viewer {
        let settings = Settings { width: 320, height: 180, ..Settings::default() };
        Viewer::new(
            scene::builtin(),
            settings,
            FilterOptions::default(),
            None,
            LoadOptions::default(),
        )
    }

    /// Pretends to draw what is due; how wide its pixels are and how many frames there are.
    fn draw(viewer: &mut Viewer, full_ms: f64, now: Instant) -> Option<(u32, usize)> {
        let Ok(Wish::Draw { settings, .. }) = viewer.next(now) else { return None };
        let scale = (320.0 / settings[0].width as f32).round() as u32;
        let filled = |part: Region| Frame::filled(part.width, part.height, [0.5; 4]);
        let frames = settings.iter().map(|s| filled(s.drawn())).collect::<Vec<_>>();
        let num = frames.len();
        viewer.drawn(Ok(Drawn { frames, ms: full_ms / f64::from(scale * scale) }));
        Some((scale, num))
    }

    #[test]
    fn moving_frames_are_coarse_and_the_still_one_is_fine() {
        let mut viewer = viewer();
        let start = Instant::now();
        (0..3).for_each(|_| {
            viewer.act(Act::Turn(0.1, 0.0));
            draw(&mut viewer, 400.0, start);
        });
        viewer.act(Act::Turn(0.1, 0.0));
        assert_eq!(draw(&mut viewer, 400.0, start), Some((3, 1)));
        assert_eq!(draw(&mut viewer, 400.0, start), None, "not yet still");
        let later = start + Duration::from_secs(5);
        assert_eq!(draw(&mut viewer, 400.0, later), Some((1, 1)));
        assert_eq!(draw(&mut viewer, 400.0, later), None, "nothing is left to draw");
    }

    #[test]
    fn number_keys_choose_filters_and_shift_splits() {
        let mut viewer = viewer();
        viewer.act(Act::Filter { number: 3, is_right: false });
        assert_eq!(viewer.filters[0], FILTERS[3].1);
        viewer.act(Act::Filter { number: 0, is_right: true });
        let Ok(Wish::Draw { settings, .. }) = viewer.next(Instant::now()) else {
            panic!("a frame is due")
        };
        assert_eq!([settings[0].filter, settings[1].filter], [FILTERS[3].1, FILTERS[0].1]);
        let [left, right] = [settings[0].drawn(), settings[1].drawn()];
        assert_eq!(
            (left.x, left.x + left.width, right.x + right.width),
            (0, right.x, settings[0].width),
            "halves"
        );
        viewer.act(Act::Filter { number: 0, is_right: false });
        (0..2).for_each(|_| _ = viewer.act(Act::Split));
        assert_ne!(viewer.filters[0], viewer.filters[1], "two halves alike show nothing");
        viewer.act(Act::Filter { number: 3, is_right: false });
        viewer.act(Act::Filter { number: 99, is_right: false });
        assert_eq!(viewer.filters[0], FILTERS[3].1, "no such filter");
    }

    #[test]
    fn the_inspector_opens_on_the_street_and_closes_before_the_window() {
        let mut viewer = viewer();
        draw(&mut viewer, 10.0, Instant::now());
        let plain = viewer.picture().bytes().to_vec();
        viewer.inspect([100, 150]);
        assert_ne!(viewer.picture().bytes(), plain);
        assert!(viewer.act(Act::Close), "the inspector closes first");
        assert_eq!(viewer.picture().bytes(), plain);
        assert!(!viewer.act(Act::Close));
        viewer.inspect([100, 5]);
        assert!(
            viewer.message.as_deref().is_some_and(|m| m.contains("sees no surface")),
            "{:?}",
            viewer.message
        );
    }

    #[test]
    fn dropped_files_load_or_say_why_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        std::fs::write(
            path("a.obj"),
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n",
        )
        .unwrap();
        Frame::filled(8, 8, [0.5, 0.5, 0.5, 1.0]).save(path("a_height.png")).unwrap();
        let mut viewer = viewer();
        assert!(viewer.load(&path("a_height.png")).is_none());
        assert!(viewer.message.take().unwrap().contains("model"));
        assert!(viewer.load(&path("none.obj")).is_none());
        assert!(viewer.message.take().unwrap().contains("none.obj"));
        assert!(
            matches!(viewer.load(&path("a.obj")), Some(Wish::Scene(_)))
                && viewer.scene.meshes.len() == 1
        );
        assert!(viewer.scene.materials[0].surface.is_none());
        assert!(viewer.load(&path("a_height.png")).is_some(), "{:?}", viewer.message);
        assert!(
            viewer.scene.materials[0]
                .surface
                .as_ref()
                .is_some_and(|surface| surface.relief_depth() > 0.0)
        );
    }
}
