//! A headless Chromium that opens a file and is used as its user would: by keys, at a window's
//! size, in light or dark. Speaks the browser's debugging protocol on a local port that the browser
//! chooses.

use base64::Engine;
use serde_json::{Value, json};
use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tungstenite::{Message, WebSocket};

/// A browser with one page, ended when dropped.
pub(crate) struct Chromium {
    browser: Child,
    socket: WebSocket<TcpStream>,
    next_id: u64,
    /// What the page said on its console, and errors that it did not catch.
    pub(crate) complaints: Vec<String>,
    _profile: tempfile::TempDir,
}

impl Chromium {
    /// Starts the browser, if there is one.
    pub(crate) fn start() -> Option<Self> {
        let profile = tempfile::tempdir().unwrap();
        let mut command = Command::new("chromium");
        command.args([
            "--headless=new",
            "--no-sandbox",
            "--disable-gpu",
            "--remote-debugging-port=0",
            "--no-first-run",
        ]);
        command.args(["--disable-background-networking", "--disable-dev-shm-usage"]);
        command.arg(format!("--user-data-dir={}", profile.path().display())).arg("about:blank");
        let browser = command
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .ok()?;
        let port = wait_for(|| {
            let text = std::fs::read_to_string(profile.path().join("DevToolsActivePort")).ok()?;
            text.lines().next()?.parse::<u16>().ok()
        });
        let url = wait_for(|| page_url(port));
        let stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
        let (socket, _) = tungstenite::client(&url, stream).unwrap();
        let mut page = Self { browser, socket, next_id: 0, complaints: vec![], _profile: profile };
        for domain in ["Page", "Runtime", "Log", "Network"] {
            page.call(&format!("{domain}.enable"), json!({}));
        }
        Some(page)
    }

    /// Opens a file and waits until it is there.
    pub(crate) fn open(&mut self, path: &Path) {
        let url = format!("file://{}", path.canonicalize().unwrap().display());
        self.call("Page.navigate", json!({ "url": url }));
        self.wait_until("document.readyState === 'complete' && location.protocol === 'file:'");
    }

    /// Sets the window's size and whether the user likes it dark.
    pub(crate) fn look(&mut self, [width, height]: [u32; 2], is_dark: bool) {
        let is_mobile = width < 600;
        self.call(
            "Emulation.setDeviceMetricsOverride",
            json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": is_mobile }),
        );
        let scheme = if is_dark { "dark" } else { "light" };
        let features = json!([{ "name": "prefers-color-scheme", "value": scheme }]);
        self.call("Emulation.setEmulatedMedia", json!({ "features": features }));
    }

    /// Presses and lets go of a key.
    pub(crate) fn press(&mut self, key: &str, code: &str, is_shifted: bool) {
        let virtual_key = match key {
            "ArrowRight" => 39,
            "ArrowLeft" => 37,
            "Tab" => 9,
            _ => 0,
        };
        for kind in ["keyDown", "keyUp"] {
            let event = json!({ "type": kind, "key": key, "code": code, "modifiers": u32::from(is_shifted) * 8,
                "windowsVirtualKeyCode": virtual_key });
            self.call("Input.dispatchKeyEvent", event);
        }
    }

    /// The value of an expression.
    pub(crate) fn value(&mut self, expression: &str) -> Value {
        let result = self
            .call("Runtime.evaluate", json!({ "expression": expression, "returnByValue": true }));
        assert!(
            result["exceptionDetails"].is_null(),
            "{expression}: {}",
            result["exceptionDetails"]
        );
        result["result"]["value"].clone()
    }

    /// Waits until an expression is true.
    pub(crate) fn wait_until(&mut self, expression: &str) {
        let start = Instant::now();
        while self.value(expression) != json!(true) {
            assert!(start.elapsed() < Duration::from_secs(60), "never true: {expression}");
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// The page as a PNG, all of it.
    pub(crate) fn screenshot(&mut self) -> Vec<u8> {
        let shot = self.call("Page.captureScreenshot", json!({ "captureBeyondViewport": true }));
        base64::prelude::BASE64_STANDARD.decode(shot["data"].as_str().unwrap()).unwrap()
    }

    fn call(&mut self, method: &str, params: Value) -> Value {
        self.next_id += 1;
        let id = self.next_id;
        let message = json!({ "id": id, "method": method, "params": params });
        self.socket.send(Message::text(message.to_string())).unwrap();
        loop {
            let Message::Text(text) = self.socket.read().unwrap() else { continue };
            let answer: Value = serde_json::from_str(&text).unwrap();
            if answer["id"] == json!(id) {
                assert!(answer["error"].is_null(), "{method}: {}", answer["error"]);
                return answer["result"].clone();
            }
            self.note(&answer);
        }
    }

    fn note(&mut self, event: &Value) {
        let params = &event["params"];
        let is_remote = |url: &str| {
            !url.starts_with("file:") && !url.starts_with("data:") && url != "about:blank"
        };
        match event["method"].as_str().unwrap_or_default() {
            "Runtime.exceptionThrown" | "Log.entryAdded" | "Runtime.consoleAPICalled" => {
                self.complaints.push(params.to_string());
            }
            "Network.requestWillBeSent"
                if params["request"]["url"].as_str().is_some_and(is_remote) =>
            {
                self.complaints.push(format!("network: {}", params["request"]["url"]));
            }
            _ => {}
        }
    }
}

impl Drop for Chromium {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.browser.kill();
        let _ = self.browser.wait();
    }
}

fn wait_for<T>(mut get: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    loop {
        if let Some(got) = get() {
            return got;
        }
        assert!(start.elapsed() < Duration::from_secs(60), "the browser does not answer");
        std::thread::sleep(Duration::from_millis(50));
    }
}

/// Where the first page's debugger listens.
fn page_url(port: u16) -> Option<String> {
    let mut stream = TcpStream::connect(("127.0.0.1", port)).ok()?;
    stream.set_read_timeout(Some(Duration::from_secs(10))).ok()?;
    stream
        .write_all(b"GET /json/list HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n")
        .ok()?;
    let mut text = Vec::new();
    let mut buffer = [0; 4096];
    loop {
        let num = stream.read(&mut buffer).unwrap_or(0);
        text.extend_from_slice(&buffer[..num]);
        let whole = String::from_utf8_lossy(&text).into_owned();
        let pages =
            whole.find("[").and_then(|start| serde_json::from_str::<Value>(&whole[start..]).ok());
        if let Some(pages) = pages {
            let page = pages.as_array()?.iter().find(|page| page["type"] == json!("page"))?.clone();
            return page["webSocketDebuggerUrl"].as_str().map(str::to_owned);
        }
        if num == 0 {
            return None;
        }
    }
}
