// What is wrong with a lesson is said with its place. Reference: faults put in one by one.
#include "engine/scene/build.hpp"
#include "tests/scene/scene_text.hpp"

using namespace tumble;

namespace {

std::string with_lesson(const std::string& lesson) {
  return R"({"tumble_scene": 1, "bodies": {}, "cameras": {"main": {}},
"lesson": )" +
         lesson + "}";
}

std::string page(const std::string& more) {
  return R"({"steps": [{"title": "t", "text": ["x"]}, {"title": "t", "text": ["x"], )" + more +
         "}]}";
}

std::string question(const std::string& more) {
  return page(R"("question": {"ask": "?", )" + more + "}");
}

}  // namespace

TEST_CASE("a lesson is read whole") {
  const SceneRead read = read_scene(
      with_lesson(page(R"("camera": "main", "overlays": ["contacts"], "plot": ["energy", "2*time"],
        "choose": ["settings.tick_hz=30"], "restart": true, "question": {"ask": "?", "answer": 3, "quantity": "3*time",
        "at": 1, "tolerance": 0.1, "unit": "m", "hint": "h", "why": "w"})")),
      "a.json");
  INFO(all_text(read.faults));
  REQUIRE(read.ok());
  REQUIRE(read.scene.lesson);
  const LessonStepDescription& step = read.scene.lesson->steps.at(1);
  CHECK(step.camera == "main");
  CHECK(step.plot == std::vector<std::string>{"energy", "2*time"});
  CHECK(step.restart);
  CHECK(*step.question->answer == 3);
  CHECK(*step.question->at == 1);
  CHECK(step.question->why == "w");
}

TEST_CASE("faults of lessons have line, path and cure") {
  const std::pair<std::string, std::string> wrong[] = {
      {R"({"steps": []})", "lesson.steps: a lesson without pages"},
      {R"({})", "steps"},
      {page(R"("camera": "mian")"),
       "lesson.steps[1].camera: unknown camera 'mian', did you mean 'main'?"},
      {page(R"("overlays": ["contact"])"),
       "lesson.steps[1].overlays[0]: unknown overlays 'contact'"},
      {page(R"("plot": ["energy <"])"), "lesson.steps[1].plot[0]"},
      {page(R"("plot": ["energy < 1"])"), "true or false"},
      {page(R"("choose": ["bodies.x=1"])"), "write settings.PATH=value or parameters.NAME=value"},
      {page(R"("choose": ["settings.tick_hz"])"), "lesson.steps[1].choose[0]"},
      {question(R"("tolerance": 1)"), "lesson.steps[1].question: has no answer"},
      {question(R"("answer": 1)"), "tolerance"},
      {question(R"("answer": 1.5, "tolerance": 0)"), "0 fits whole numbers only"},
      {question(R"("answer": 1, "at": 1, "tolerance": 0)"),
       "lesson.steps[1].question.at: the moment of what?"},
      {question(R"("quantity": "1 > 0", "tolerance": 1)"), "lesson.steps[1].question.quantity"},
      {question(R"("answer": 1, "tolerance": -1)"), "lesson.steps[1].question.tolerance"},
      {question(R"("answer": "one", "tolerance": 1)"), "lesson.steps[1].question.answer"},
  };
  for (const auto& [lesson, words] : wrong) {
    const auto& step = lesson;
    INFO(step);
    const SceneRead read = read_scene(with_lesson(lesson), "a.json");
    REQUIRE_FALSE(read.ok());
    const std::string text = all_text(read.faults);
    CHECK_MESSAGE(text.find(words) != std::string::npos, text);
    CHECK(read.faults[0].line == 2);
  }
}
