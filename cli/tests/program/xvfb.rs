//! A screen without a screen, and a hand on its keys and mouse. Ended when dropped.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use x11rb::connection::Connection;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    self, Atom, ClientMessageEvent, ConnectionExt as _, EventMask, ImageFormat, InputFocus,
    PropMode, SelectionNotifyEvent, Window,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;
use x11rb::wrapper::ConnectionExt as _;

/// A virtual X server.
pub(crate) struct Screen {
    server: Child,
    pub(crate) display: String,
    connection: RustConnection,
    root: Window,
}

/// Red, green and blue of each pixel.
#[derive(PartialEq)]
pub(crate) struct Shot {
    pub(crate) width: usize,
    pub(crate) pixels: Vec<[u8; 3]>,
}

impl Screen {
    /// Starts the server, if there is one.
    pub(crate) fn start(width: u32, height: u32) -> Option<Self> {
        let mut command = Command::new("Xvfb");
        command.args([
            "-displayfd",
            "1",
            "-nolisten",
            "tcp",
            "-screen",
            "0",
            &format!("{width}x{height}x24"),
        ]);
        let mut server = command
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .ok()?;
        let mut number = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut number).unwrap();
        let display = format!(":{}", number.trim());
        let (connection, screen) = x11rb::connect(Some(&display)).unwrap();
        let root = connection.setup().roots[screen].root;
        Some(Self { server, display, connection, root })
    }

    /// Waits for a window, and gives it the keyboard, since no window manager does.
    pub(crate) fn window(&self) -> Window {
        let window = wait_for("a window", || {
            let children = self.connection.query_tree(self.root).unwrap().reply().unwrap().children;
            children.into_iter().find(|child| {
                let attributes = self.connection.get_window_attributes(*child).unwrap().reply();
                let geometry = self.connection.get_geometry(*child).unwrap().reply();
                attributes.is_ok_and(|a| a.map_state == xproto::MapState::VIEWABLE)
                    && geometry.is_ok_and(|g| g.width > 50)
            })
        });
        self.connection.set_input_focus(InputFocus::PARENT, window, x11rb::CURRENT_TIME).unwrap();
        self.connection.sync().unwrap();
        window
    }

    /// What a window shows.
    pub(crate) fn shot(&self, window: Window) -> Shot {
        let geometry = self.connection.get_geometry(window).unwrap().reply().unwrap();
        let (width, height) = (geometry.width, geometry.height);
        let image =
            self.connection.get_image(ImageFormat::Z_PIXMAP, window, 0, 0, width, height, u32::MAX);
        let data = image.unwrap().reply().unwrap().data;
        Shot {
            width: usize::from(width),
            pixels: data.chunks_exact(4).map(|p| [p[2], p[1], p[0]]).collect(),
        }
    }

    /// Waits until a window shows what is asked for, and then no more change.
    pub(crate) fn wait_for(
        &self,
        window: Window,
        what: &str,
        is_there: impl Fn(&Shot) -> bool,
    ) -> Shot {
        let mut last = self.shot(window);
        let mut since = Instant::now();
        wait_for(what, || {
            std::thread::sleep(Duration::from_millis(50));
            let shot = self.shot(window);
            if shot != last {
                (last, since) = (shot, Instant::now());
            }
            let is_still = since.elapsed() > Duration::from_millis(800);
            (is_still && is_there(&last)).then_some(())
        });
        last
    }

    /// Presses and lets go of the key of a keysym.
    pub(crate) fn press(&self, keysym: u32) {
        let setup = self.connection.setup();
        let (first, last) = (setup.min_keycode, setup.max_keycode);
        let map =
            self.connection.get_keyboard_mapping(first, last - first + 1).unwrap().reply().unwrap();
        let per_key = usize::from(map.keysyms_per_keycode);
        let key =
            map.keysyms.chunks(per_key).position(|syms| syms[0] == keysym).expect("a key for it")
                as u8
                + first;
        self.event(xproto::KEY_PRESS_EVENT, key, [0, 0]);
        self.event(xproto::KEY_RELEASE_EVENT, key, [0, 0]);
    }

    /// Moves the pointer.
    pub(crate) fn point(&self, [x, y]: [i16; 2]) {
        self.event(xproto::MOTION_NOTIFY_EVENT, 0, [x, y]);
    }

    /// Presses or lets go of a mouse button.
    pub(crate) fn button(&self, number: u8, is_down: bool) {
        self.event(
            if is_down { xproto::BUTTON_PRESS_EVENT } else { xproto::BUTTON_RELEASE_EVENT },
            number,
            [0, 0],
        );
    }

    fn event(&self, kind: u8, detail: u8, [x, y]: [i16; 2]) {
        self.connection
            .xtest_fake_input(kind, detail, x11rb::CURRENT_TIME, self.root, x, y, 0)
            .unwrap();
        self.connection.sync().unwrap();
        std::thread::sleep(Duration::from_millis(30));
    }

    fn atom(&self, name: &str) -> Atom {
        self.connection.intern_atom(false, name.as_bytes()).unwrap().reply().unwrap().atom
    }

    /// Drops a file on a window, as a file manager does (the XDND protocol).
    pub(crate) fn drop_file(&self, window: Window, path: &std::path::Path) {
        let connection = &self.connection;
        let source = connection.generate_id().unwrap();
        let aux = xproto::CreateWindowAux::new();
        let class = xproto::WindowClass::INPUT_OUTPUT;
        connection.create_window(0, source, self.root, 700, 500, 1, 1, 0, class, 0, &aux).unwrap();
        let [selection, list, copy] =
            ["XdndSelection", "text/uri-list", "XdndActionCopy"].map(|name| self.atom(name));
        connection.set_selection_owner(source, selection, x11rb::CURRENT_TIME).unwrap();
        let send = |name: &str, data: [u32; 5]| {
            let message = ClientMessageEvent::new(32, window, self.atom(name), data);
            connection.send_event(false, window, EventMask::NO_EVENT, message).unwrap();
            connection.sync().unwrap();
        };
        send("XdndEnter", [source, 5 << 24, list, 0, 0]);
        send("XdndPosition", [source, 0, 50 << 16 | 50, 0, copy]);
        let uris = format!("file://{}\r\n", path.display());
        wait_for("the window asks what is dropped", || {
            let Event::SelectionRequest(request) = connection.poll_for_event().unwrap()? else {
                return None;
            };
            let property = request.property;
            connection
                .change_property8(
                    PropMode::REPLACE,
                    request.requestor,
                    property,
                    list,
                    uris.as_bytes(),
                )
                .unwrap();
            let event = SelectionNotifyEvent {
                response_type: xproto::SELECTION_NOTIFY_EVENT,
                sequence: 0,
                time: request.time,
                requestor: request.requestor,
                selection: request.selection,
                target: request.target,
                property,
            };
            connection.send_event(false, request.requestor, EventMask::NO_EVENT, event).unwrap();
            connection.sync().unwrap();
            Some(())
        });
        std::thread::sleep(Duration::from_millis(200));
        send("XdndDrop", [source, 0, 0, 0, 0]);
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

fn wait_for<T>(what: &str, mut get: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    loop {
        if let Some(got) = get() {
            return got;
        }
        assert!(start.elapsed() < Duration::from_secs(60), "never came: {what}");
        std::thread::sleep(Duration::from_millis(20));
    }
}
