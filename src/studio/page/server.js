/* Requests to the program that serves the page. */

/** A request that the program refuses: where in the scenario, why, and both in a whole sentence. */
class Refused extends Error {
  constructor({ path = "", reason, message }) {
    super(message);
    this.path = path;
    this.reason = reason ?? message;
  }
}

/** The answer to a request, relative to the address of the page: a POST if there is a body. */
async function answerOf(path, options = {}) {
  const response = await fetch(path, { cache: "no-store", ...options });
  if (response.ok) return response;
  const said = await response.json().catch(() => ({}));
  throw new Refused(said.error ?? { message: `${path}: the program answers ${response.status}` });
}

/** The JSON that answers a request; a body is sent as JSON, in a POST. */
async function ask(path, body) {
  const headers = { "Content-Type": "application/json" };
  const post = body === undefined ? {} : { method: "POST", headers, body: JSON.stringify(body) };
  return (await answerOf(path, post)).json();
}
