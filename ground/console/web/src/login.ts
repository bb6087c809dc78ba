// Coming in from another computer: the code of the QR code or the terminal becomes a session, once.
import { h, setText } from "./ui";

async function logIn(code: string): Promise<string> {
  const reply = await fetch("api/login", { method: "POST", body: code.trim() });
  return reply.ok ? "" : (await reply.text()).trim();
}

function askForCode(parent: HTMLElement): Promise<void> {
  return new Promise((resolve) => {
    const input = h("input", { type: "text", autocomplete: "off", autocapitalize: "off", spellcheck: false, id: "code", required: true });
    const why = h("p", { class: "why", role: "alert" });
    const form = h("form", { class: "login" }, h("img", { src: "icon.svg", alt: "", width: 72, height: 72 }), h("h1", {}, "Isotherm"),
      h("label", { for: "code" }, "The code that the ground service shows"), input, h("button", { type: "submit", class: "primary" }, "Come in"), why);
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      void logIn(input.value).then((problem) => {
        if (problem === "") {
          form.remove();
          resolve();
        } else setText(why, problem);
      });
    });
    parent.append(form);
    input.focus();
  });
}

/** Returns once the service lets this page in. */
export async function comeIn(parent: HTMLElement): Promise<void> {
  const code = new URLSearchParams(location.hash.slice(1)).get("code");
  if (code !== null) {
    // Out of the address before anybody copies it.
    history.replaceState(null, "", location.pathname);
    if (await logIn(code) === "") return;
  }
  for (;;) {
    try {
      const reply = await fetch("api/scan");
      if (reply.status !== 401) return;
      return await askForCode(parent);
    } catch {
      await new Promise((resolve) => setTimeout(resolve, 1000));
    }
  }
}
