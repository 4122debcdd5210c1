(() => {
  // Shows how many questions of each lesson are answered. The explorer keeps the answers in the local storage of the browser.
  const showProgress = () => {
    let answers = {};
    try {
      answers = JSON.parse(localStorage.getItem("sixfold-explorer"))?.course?.answers ?? {};
    } catch {
      // The browser does not allow it, or something else stands there.
    }
    for (const place of document.querySelectorAll("[data-questions]")) {
      const ids = place.dataset.questions.split(" ");
      const done = ids.filter((id) => answers[id]?.right === true || answers[id]?.shown === true).length;
      place.textContent = done ? `${done === ids.length ? "✓ " : ""}${done} of ${ids.length}` : "";
    }
  };
  showProgress();
  addEventListener("pageshow", showProgress);
  addEventListener("storage", showProgress);

  // On a narrow screen, the explorer opens below the text.
  const section = document.querySelector("#explorer");
  const open = () => {
    section.classList.add("open");
    section.scrollIntoView();
  };
  section?.querySelector("button").addEventListener("click", open);
  for (const link of document.querySelectorAll("a[target=explorer]")) {
    link.addEventListener("click", () => matchMedia("(max-width: 60rem)").matches && open());
  }
})();
