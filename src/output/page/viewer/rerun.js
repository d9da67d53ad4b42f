/* The Rerun viewer, in pages that have it and a recording. */

/** The marks in the viewer's script around the request for its program, which is in the page. */
const [REQUEST, REQUESTED] = ["//!<INLINE-MARKER-OPEN>", "//!<INLINE-MARKER-CLOSE>"];

/** Opens the recording of the page in the Rerun viewer, in an element. */
async function openRerun(place) {
  const all = async name => new Blob(await Promise.all([...document.getElementsByClassName(name)].map(inflated)));
  const [script, program, recording] = await Promise.all(["rerun-script", "rerun-program", "recording"].map(all));
  const bytes = await recording.arrayBuffer();
  const [before, after] = (await script.text()).split(REQUEST);
  const [, rest] = after.split(REQUESTED);
  globalThis.rerunProgram = () => new Response(program, { headers: { "Content-Type": "application/wasm" } });
  const parts = [before, "return globalThis.rerunProgram();", rest];
  const { default: widget } = await import(URL.createObjectURL(new Blob(parts, { type: "text/javascript" })));
  const values = { _width: "auto", _height: 800, _theme: "dark" };
  const listeners = {};
  const model = {
    get: name => values[name] ?? null,
    on: (name, does) => listeners[name] = does,
    send: message => message === "ready" && listeners["msg:custom"]({ type: "rrd" }, [{ buffer: bytes }]),
  };
  widget.render({ model, el: place });
}

addEventListener("DOMContentLoaded", () => {
  if (!document.getElementsByClassName("recording").length) return;
  const button = element("button", { id: "rerun", textContent: "open the whole recording in the Rerun viewer" });
  document.querySelector("main").after(element("section", { className: "rerun" }, button));
  button.addEventListener("click", async () => {
    button.disabled = true;
    button.textContent = "opening the Rerun viewer …";
    try {
      await openRerun(button.parentElement);
      button.remove();
    } catch (error) {
      button.textContent = `the Rerun viewer cannot start: ${error}`;
      throw error;
    }
  });
});
