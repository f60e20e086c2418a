//! The window: winit for events, softbuffer for pixels.

use crate::refusal::Refusal;
use crate::view::state::{Act, Viewer};
use crate::view::worker::{Answer, Worker};
use softbuffer::{Context, Surface};
use std::num::NonZeroU32;
use std::rc::Rc;
use std::time::{Duration, Instant};
use winit::application::ApplicationHandler;
use winit::dpi::{PhysicalPosition, PhysicalSize};
use winit::event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, OwnedDisplayHandle};
use winit::keyboard::{KeyCode, ModifiersState, PhysicalKey};
use winit::window::{Window, WindowId};

/// A drag is a move of more pixels than this; less is a click.
const CLICK: f64 = 3.0;
/// Radians a pixel of a drag, and a key.
const DRAG_TURN: f32 = 0.006;
const KEY_TURN: f32 = 0.08;
/// Radians a second of a spin.
const SPIN: f32 = 0.5;

/// Shows the viewer until it is closed, or for the time of a spin, of which it gives a report.
pub(crate) fn run(
    viewer: Viewer,
    num_threads: usize,
    spin: Option<Duration>,
) -> Result<Option<String>, Refusal> {
    let events = EventLoop::<Answer>::with_user_event().build().map_err(|e| no_window(&e))?;
    let proxy = events.create_proxy();
    let answer = move |answer| {
        // The window may be gone before its last frame is drawn.
        let _ = proxy.send_event(answer);
    };
    let worker = Worker::start(viewer.scene(), num_threads, answer)
        .map_err(|e| format!("--threads: {e}"))?;
    let context = Context::new(events.owned_display_handle())
        .map_err(|e| format!("no pixels can be shown: {e}"))?;
    let mut app = App {
        viewer,
        worker,
        context,
        shown: None,
        pointer: Pointer::default(),
        modifiers: ModifiersState::empty(),
        spin: spin.map(Spin::new),
        failure: None,
    };
    events.run_app(&mut app).map_err(|e| format!("the window failed: {e}"))?;
    match app.failure {
        Some(failure) => Err(failure),
        None => Ok(app.spin.map(|spin| spin.report(&app.viewer))),
    }
}

/// Why there is no window; without the line of source that winit puts before the reason.
fn no_window(error: &dyn std::error::Error) -> Refusal {
    let text = error.to_string();
    let reason = text
        .split_once(".rs:")
        .and_then(|(_, rest)| rest.split_once(": "))
        .map_or(&*text, |(_, reason)| reason);
    format!("no window can be opened: {reason}").into()
}

type Pixels = Surface<OwnedDisplayHandle, Rc<Window>>;

struct App {
    viewer: Viewer,
    worker: Worker,
    context: Context<OwnedDisplayHandle>,
    shown: Option<(Rc<Window>, Pixels)>,
    pointer: Pointer,
    modifiers: ModifiersState,
    spin: Option<Spin>,
    failure: Option<Refusal>,
}

/// Where the pointer is, and since where which button has been down.
#[derive(Default)]
struct Pointer {
    place: PhysicalPosition<f64>,
    pressed: Option<(MouseButton, PhysicalPosition<f64>)>,
    is_dragging: bool,
}

/// Going around by itself.
struct Spin {
    wanted: Duration,
    started: Option<(Instant, u32)>,
    last: Instant,
    took: Duration,
    num: u32,
}

impl Spin {
    fn new(wanted: Duration) -> Self {
        Self { wanted, started: None, last: Instant::now(), took: Duration::ZERO, num: 0 }
    }

    /// Goes on after a frame; whether the time is over. Begins with the first frame.
    fn step(&mut self, viewer: &mut Viewer) -> bool {
        let now = Instant::now();
        let (start, before) = *self.started.get_or_insert((now, viewer.num_drawn()));
        (self.took, self.num) = (now - start, viewer.num_drawn() - before);
        viewer.act(Act::Turn(
            (now - std::mem::replace(&mut self.last, now)).as_secs_f32().min(0.2) * SPIN,
            0.0,
        ));
        self.took >= self.wanted
    }

    fn report(&self, viewer: &Viewer) -> String {
        let per_second = f64::from(self.num) / self.took.as_secs_f64().max(1e-9);
        let ([width, height], scale) = (viewer.size(), viewer.shown_scale());
        format!(
            "{per_second:.1} frames a second at {width}x{height}, the last in pixels of {scale}x{scale}"
        )
    }
}

impl App {
    fn fail(&mut self, events: &ActiveEventLoop, failure: Refusal) {
        self.failure.get_or_insert(failure);
        events.exit();
    }

    /// Asks for the next frame if one is due.
    fn proceed(&mut self, events: &ActiveEventLoop) {
        match self.viewer.next(Instant::now()) {
            Ok(wish) => self.worker.wish(wish),
            Err(Some(later)) => events.set_control_flow(ControlFlow::WaitUntil(later)),
            Err(None) => events.set_control_flow(ControlFlow::Wait),
        }
    }

    fn act(&mut self, events: &ActiveEventLoop, act: Act) {
        if !self.viewer.act(act) {
            events.exit();
        }
        self.redraw();
    }

    fn redraw(&self) {
        if let Some((window, _)) = &self.shown {
            window.request_redraw();
        }
    }

    fn open(&mut self, events: &ActiveEventLoop) -> Result<(), Refusal> {
        let [width, height] = self.viewer.size();
        let attributes = Window::default_attributes()
            .with_title("basrelief")
            .with_inner_size(PhysicalSize::new(width, height));
        let window = Rc::new(events.create_window(attributes).map_err(|e| no_window(&e))?);
        let surface = Surface::new(&self.context, window.clone()).map_err(|e| no_window(&e))?;
        self.shown = Some((window, surface));
        Ok(())
    }

    fn paint(&mut self) -> Result<(), softbuffer::SoftBufferError> {
        let [width, height] = self.viewer.size();
        let (Some((window, surface)), Some(w), Some(h)) =
            (&mut self.shown, NonZeroU32::new(width), NonZeroU32::new(height))
        else {
            return Ok(());
        };
        surface.resize(w, h)?;
        let picture = self.viewer.picture();
        let mut buffer = surface.buffer_mut()?;
        for (pixel, bytes) in buffer.iter_mut().zip(picture.bytes().chunks_exact(4)) {
            *pixel = u32::from_be_bytes([0, bytes[0], bytes[1], bytes[2]]);
        }
        window.pre_present_notify();
        buffer.present()
    }

    fn key(&mut self, events: &ActiveEventLoop, code: KeyCode) {
        if code == KeyCode::KeyI {
            let PhysicalPosition { x, y } = self.pointer.place;
            self.inspect(x, y);
        } else if let Some(act) = act_of(code, self.modifiers.shift_key()) {
            self.act(events, act);
        }
    }

    fn inspect(&mut self, x: f64, y: f64) {
        self.viewer.inspect([x, y].map(|c| c.max(0.0) as u32));
        self.redraw();
    }

    fn moved(&mut self, events: &ActiveEventLoop, place: PhysicalPosition<f64>) {
        let before = std::mem::replace(&mut self.pointer.place, place);
        let Some((button, start)) = self.pointer.pressed else { return };
        self.pointer.is_dragging |= (place.x - start.x).hypot(place.y - start.y) > CLICK;
        if self.pointer.is_dragging {
            let [dx, dy] = [place.x - before.x, place.y - before.y].map(|c| c as f32);
            let height = self.viewer.size()[1] as f32;
            let pans = button != MouseButton::Left || self.modifiers.shift_key();
            let act = if pans {
                Act::Pan(-dx / height, dy / height)
            } else {
                Act::Turn(-dx * DRAG_TURN, dy * DRAG_TURN)
            };
            self.act(events, act);
        }
    }

    fn button(&mut self, state: ElementState, button: MouseButton) {
        if state == ElementState::Pressed {
            (self.pointer.pressed, self.pointer.is_dragging) =
                (Some((button, self.pointer.place)), false);
        } else if self.pointer.pressed.take().is_some()
            && !self.pointer.is_dragging
            && button == MouseButton::Left
        {
            let PhysicalPosition { x, y } = self.pointer.place;
            self.inspect(x, y);
        }
    }
}

/// What a key means.
fn act_of(code: KeyCode, is_shifted: bool) -> Option<Act> {
    let digits = [
        KeyCode::Digit1,
        KeyCode::Digit2,
        KeyCode::Digit3,
        KeyCode::Digit4,
        KeyCode::Digit5,
        KeyCode::Digit6,
        KeyCode::Digit7,
        KeyCode::Digit8,
    ];
    if let Some(number) = digits.iter().position(|digit| *digit == code) {
        return Some(Act::Filter { number, is_right: is_shifted });
    }
    Some(match code {
        KeyCode::ArrowLeft => Act::Turn(-KEY_TURN, 0.0),
        KeyCode::ArrowRight => Act::Turn(KEY_TURN, 0.0),
        KeyCode::ArrowUp => Act::Turn(0.0, KEY_TURN),
        KeyCode::ArrowDown => Act::Turn(0.0, -KEY_TURN),
        KeyCode::KeyA => Act::Pan(-0.05, 0.0),
        KeyCode::KeyD => Act::Pan(0.05, 0.0),
        KeyCode::KeyW => Act::Pan(0.0, 0.05),
        KeyCode::KeyS => Act::Pan(0.0, -0.05),
        KeyCode::Equal | KeyCode::NumpadAdd => Act::Zoom(1.0),
        KeyCode::Minus | KeyCode::NumpadSubtract => Act::Zoom(-1.0),
        KeyCode::Tab => Act::Split,
        KeyCode::KeyL => Act::Light,
        KeyCode::KeyR => Act::Home,
        KeyCode::KeyH | KeyCode::F1 => Act::Help,
        KeyCode::Escape => Act::Close,
        _ => return None,
    })
}

impl ApplicationHandler<Answer> for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if let Err(e) = self.open(events) {
            self.fail(events, e);
        }
    }

    fn user_event(&mut self, events: &ActiveEventLoop, answer: Answer) {
        self.viewer.drawn(answer);
        if self.spin.as_mut().is_some_and(|spin| spin.step(&mut self.viewer)) {
            events.exit();
        }
        self.redraw();
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::Resized(size) => self.viewer.resize([size.width, size.height]),
            WindowEvent::RedrawRequested => {
                if let Err(e) = self.paint() {
                    self.fail(events, format!("no pixels can be shown: {e}").into());
                }
            }
            WindowEvent::ModifiersChanged(modifiers) => self.modifiers = modifiers.state(),
            WindowEvent::CursorMoved { position, .. } => self.moved(events, position),
            WindowEvent::MouseInput { state, button, .. } => self.button(state, button),
            WindowEvent::MouseWheel { delta, .. } => {
                let steps = match delta {
                    MouseScrollDelta::LineDelta(_, lines) => lines,
                    MouseScrollDelta::PixelDelta(pixels) => pixels.y as f32 / 40.0,
                };
                self.act(events, Act::Zoom(steps));
            }
            WindowEvent::KeyboardInput { event, .. } if event.state == ElementState::Pressed => {
                if let PhysicalKey::Code(code) = event.physical_key {
                    self.key(events, code);
                }
            }
            WindowEvent::DroppedFile(path) => {
                if let Some(wish) = self.viewer.load(&path) {
                    self.worker.wish(wish);
                }
                self.redraw();
            }
            _ => {}
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        self.proceed(events);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn number_keys_are_filters_and_shift_is_the_right_half() {
        assert_eq!(
            act_of(KeyCode::Digit1, false),
            Some(Act::Filter { number: 0, is_right: false })
        );
        assert_eq!(act_of(KeyCode::Digit8, true), Some(Act::Filter { number: 7, is_right: true }));
        assert_eq!(act_of(KeyCode::KeyZ, false), None);
    }
}
