//! rust-analyzer as an editor drives it: a process that is asked by messages.

use std::io::{BufReader, BufWriter};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use lsp_server::{ErrorCode, Message, Notification, Request, Response};
use serde_json::{Value, json};

use crate::machine::Position;

/// A running rust-analyzer with one document open.
pub struct Editor {
    process: Child,
    input: BufWriter<ChildStdin>,
    output: BufReader<ChildStdout>,
    uri: String,
    last: i32,
}

/// Whether there is a rust-analyzer.
pub fn is_there() -> bool {
    let version = Command::new("rust-analyzer").arg("--version").output();
    version.is_ok_and(|output| output.status.success())
}

impl Editor {
    /// Opens `src/lib.rs` of the crate in a folder, and waits until its macros are built.
    pub fn open(folder: &Path, target: &Path) -> Self {
        let mut command = Command::new("rust-analyzer");
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut process = command.spawn().expect("rust-analyzer runs");
        let (input, output) = (process.stdin.take().expect("a pipe"), process.stdout.take().expect("a pipe"));
        let file = folder.join("src/lib.rs");
        let uri = format!("file://{}", file.display());
        let (input, output) = (BufWriter::new(input), BufReader::new(output));
        let mut editor = Self { process, input, output, uri, last: 0 };
        editor.ask(
            "initialize",
            &json!({
                "processId": null,
                "rootUri": format!("file://{}", folder.display()),
                "capabilities": {
                    "textDocument": { "hover": { "contentFormat": ["markdown"] }, "diagnostic": {} },
                    "experimental": { "serverStatusNotification": true },
                },
                "initializationOptions": {
                    "checkOnSave": false,
                    "cachePriming": { "enable": false },
                    "cargo": { "extraEnv": { "CARGO_NET_OFFLINE": "true", "CARGO_TARGET_DIR": target } },
                },
            }),
        );
        editor.tell("initialized", json!({}));
        let text = std::fs::read_to_string(&file).expect("the document");
        let document = json!({ "uri": editor.uri, "languageId": "rust", "version": 0, "text": text });
        editor.tell("textDocument/didOpen", json!({ "textDocument": document }));
        loop {
            if let Message::Notification(told) = editor.receive()
                && told.method == "experimental/serverStatus"
                && told.params["quiescent"] == true
            {
                return editor;
            }
        }
    }

    /// Asks something of a place in the document. `more` is what the question says besides.
    pub fn at(&mut self, question: &str, (line, column): Position, more: Value) -> Value {
        let position = json!({ "line": line, "character": column });
        let mut parameters = json!({ "textDocument": { "uri": self.uri }, "position": position });
        if let (Value::Object(parameters), Value::Object(more)) = (&mut parameters, more) {
            parameters.extend(more);
        }
        self.ask(&format!("textDocument/{question}"), &parameters)
    }

    /// What is wrong with the document.
    pub fn diagnostics(&mut self) -> Value {
        let document = json!({ "textDocument": { "uri": self.uri } });
        self.ask("textDocument/diagnostic", &document)
    }

    /// Changes the document.
    pub fn change(&mut self, text: &str) {
        self.last += 1;
        let document = json!({ "uri": self.uri, "version": self.last });
        let changes = json!({ "textDocument": document, "contentChanges": [{ "text": text }] });
        self.tell("textDocument/didChange", changes);
    }

    /// The answer to a question, or the error.
    fn ask(&mut self, method: &str, parameters: &Value) -> Value {
        loop {
            self.last += 1;
            let id = self.last;
            self.send(Request::new(id.into(), method.to_owned(), parameters).into());
            let answer = loop {
                match self.receive() {
                    Message::Response(answer) if answer.id == id.into() => break answer,
                    _ => {}
                }
            };
            match answer.response_result {
                Ok(result) => return result,
                // It has read more of the crate in the meantime.
                Err(error) if error.code == ErrorCode::ContentModified as i32 => {}
                Err(error) => return json!({ "error": error.message }),
            }
        }
    }

    fn tell(&mut self, method: &str, parameters: Value) {
        self.send(Notification::new(method.to_owned(), parameters).into());
    }

    fn send(&mut self, message: Message) {
        message.write(&mut self.input).expect("rust-analyzer listens");
    }

    /// The next message. What the server asks is answered: it has no settings and may do everything.
    fn receive(&mut self) -> Message {
        let message = Message::read(&mut self.output).expect("a message").expect("rust-analyzer goes on");
        if let Message::Request(request) = &message {
            let settings = request.params["items"].as_array().map(|items| vec![Value::Null; items.len()]);
            self.send(Response::new_ok(request.id.clone(), settings).into());
        }
        message
    }
}

impl Drop for Editor {
    fn drop(&mut self) {
        // Both fail only where the process has ended.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
