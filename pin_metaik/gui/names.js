// Names for a screen reader and keys for a keyboard, of what viser draws without them.
(() => {
  const ICONS = {"list-search": "Commands", adjustments: "Configuration and diagnostics", maximize: "Enlarge the plot"};

  const named = (element, name) => {
    if (!element.hasAttribute("aria-label") || element.getAttribute("aria-label") === "") {
      element.setAttribute("aria-label", name);
    }
  };

  // Sliders, texts and all parts of a vector: viser ties its label to the first input, or to none.
  const inputs = () => {
    for (const label of document.querySelectorAll("label[for]")) {
      const row = label.closest(".mantine-Flex-root");
      if (row === null) continue;
      const name = label.textContent.trim();
      const fields = row.querySelectorAll("input:not([type=checkbox], [type=hidden]), textarea, [role=slider]");
      const typed = [...fields].filter((field) => field.getAttribute("role") !== "slider");
      for (const field of fields) {
        const part = typed.length > 1 && typed.includes(field) ? `, ${typed.indexOf(field) + 1} of ${typed.length}` : "";
        named(field, name + part);
      }
      for (const button of row.querySelectorAll("button[data-direction]")) {
        named(button, `${button.dataset.direction === "up" ? "more" : "less"}: ${name}`);
      }
    }
  };

  // Folders open by a click on their title only: make it a button.
  const folders = () => {
    for (const icon of document.querySelectorAll(".tabler-icon-chevron-down, .tabler-icon-chevron-up")) {
      const title = icon.parentElement;
      if (!title.matches(".mantine-Paper-root > .mantine-Paper-root")) continue;
      title.setAttribute("aria-expanded", String(icon.matches(".tabler-icon-chevron-up")));
      if (title.getAttribute("role") === "button") continue;
      title.setAttribute("role", "button");
      title.tabIndex = 0;
      title.addEventListener("keydown", (event) => {
        if (event.target === title && (event.key === "Enter" || event.key === " ")) {
          event.preventDefault();
          title.click();
        }
      });
    }
  };

  const pictures = () => {
    for (const [icon, name] of Object.entries(ICONS)) {
      for (const drawn of document.querySelectorAll(`button .tabler-icon-${icon}`)) named(drawn.closest("button"), name);
    }
    for (const cross of document.querySelectorAll(".mantine-Notification-closeButton")) named(cross, "Dismiss the notification");
    for (const canvas of document.querySelectorAll("canvas")) {
      canvas.setAttribute("role", "img");
      named(canvas, canvas.closest(".uplot") === null ? "Scene" : "Plot");
    }
  };

  let waits = false;
  const look = () => {
    waits = false;
    inputs();
    folders();
    pictures();
  };
  new MutationObserver(() => {
    if (!waits) {
      waits = true;
      requestAnimationFrame(look);
    }
  }).observe(document.documentElement, {childList: true, subtree: true});
})();
