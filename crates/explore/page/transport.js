// The way to the engine: the program's server on this machine.

const token = new URLSearchParams(location.search).get("token") ?? "";
// Two tabs must not end each other's requests.
const tab = Math.random().toString(36).slice(2, 10);

async function post(path, body, lane, signal) {
  let response;
  try {
    response = await fetch(`${path}?lane=${tab}-${lane}`, {
      method: "POST",
      headers: { "Content-Type": "application/json", "X-Hertzchain-Token": token },
      body: JSON.stringify(body),
      signal,
    });
  } catch (error) {
    if (error.name === "AbortError") return { refused: "stopped" };
    return { refused: { error: "The engine is gone: start `hertzchain explore` again and open its address." } };
  }
  return response.json();
}

/** What the page starts with. */
export const start = () => post("start", null, "start");

/** The answer to a request; a newer one in the same lane ends it. */
export const answer = (lane, request, signal) => post("answer", request, lane, signal);

/** How far the work of a lane is. */
export const progress = (lane) => post("progress", null, lane);

/** Ends the work of a lane. */
export const cancel = (lane) => post("cancel", null, lane);
