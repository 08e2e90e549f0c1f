// One form on its way to the service. XMLHttpRequest, since fetch does not tell how much of a body is gone.

import { Problem, headers, problemOf } from "../shared/api.js";

/** Write the form of an upload. */
export function formOf({ files, untextured }) {
  const form = new FormData();
  for (const { path, file } of files) form.append("files", file, path);
  if (untextured) form.append("allow_untextured", "true");
  return form;
}

/**
 * Send a form.
 *
 * @param {string} address
 * @param {FormData} form
 * @param {{signal: AbortSignal, onSent: (share: number) => void}} how - `onSent` hears how much is gone, 0 to 1
 * @returns {Promise<{status: number, body: object}>}
 * @throws {Problem} with `wait`, in seconds, where the service says how long
 */
export function send(address, form, { signal, onSent }) {
  return new Promise((resolve, reject) => {
    const call = new XMLHttpRequest();
    call.open("POST", address);
    for (const [name, value] of Object.entries(headers())) call.setRequestHeader(name, value);
    call.upload.onprogress = ({ loaded, total }) => onSent(total ? loaded / total : 0);
    call.upload.onload = () => onSent(1);
    call.onload = () => {
      const body = call.status < 300 && parsed(call.responseText);
      if (body) resolve({ status: call.status, body });
      else reject(refusalOf(call));
    };
    call.onerror = () => reject(new Problem(0));
    call.onabort = () => reject(new DOMException("cancelled", "AbortError"));
    signal.addEventListener("abort", () => call.abort());
    call.send(form);
  });
}

function parsed(text) {
  try {
    return JSON.parse(text);
  } catch {
    return undefined; // a proxy in between answered
  }
}

function refusalOf(call) {
  const problem = problemOf(call.status, call.responseText);
  problem.wait = Number(call.getResponseHeader("Retry-After")) || undefined;
  return problem;
}
