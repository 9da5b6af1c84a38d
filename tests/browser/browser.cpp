#include "tests/browser/browser.h"

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace dapple::testing_support {

namespace {

using Json = nlohmann::json;

constexpr int kTimeoutMilliseconds = 60'000;

/// Puts the ends of the pipes where Chromium looks for them, 3 to read and 4 to write, and becomes it.
[[noreturn]] void Become(const std::string& program, const std::vector<std::string>& arguments, int in, int out) {
  // First out of the way of 3 and 4.
  const int safeIn = fcntl(in, F_DUPFD, 10), safeOut = fcntl(out, F_DUPFD, 10);
  dup2(safeIn, 3);
  dup2(safeOut, 4);
  const int nothing = open("/dev/null", O_RDWR);
  for (const int stream : {0, 1, 2}) dup2(nothing, stream);
  std::vector<char*> pointers{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);
  execv(program.c_str(), pointers.data());
  _exit(127);
}

std::string DecodeBase64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const size_t digit = digits.find(c);
    if (digit == std::string::npos) break;
    bits = bits << 6 | static_cast<uint32_t>(digit);
    count += 6;
    if (count >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 255);
  }
  return bytes;
}

}  // namespace

std::string FindChromium() {
  std::istringstream path(std::getenv("PATH") ? std::getenv("PATH") : "");
  for (std::string folder; std::getline(path, folder, ':');) {
    const std::string program = folder + "/chromium";
    if (access(program.c_str(), X_OK) == 0) return program;
  }
  return "";
}

Browser::Browser(const std::string& program, const std::string& profileFolder, int width, int height) {
  int toBrowser[2], fromBrowser[2];
  if (pipe2(toBrowser, O_CLOEXEC) != 0 || pipe2(fromBrowser, O_CLOEXEC) != 0) throw std::runtime_error("no pipes");
  signal(SIGPIPE, SIG_IGN);
  std::vector<std::string> arguments{"--headless",
                                     "--remote-debugging-pipe",
                                     "--disable-gpu",
                                     "--hide-scrollbars",
                                     "--no-first-run",
                                     "--disable-dev-shm-usage",
                                     "--disable-extensions",
                                     "--disable-background-networking",
                                     "--user-data-dir=" + profileFolder,
                                     "about:blank"};
  if (geteuid() == 0) arguments.insert(arguments.begin(), "--no-sandbox");  // which root cannot have
  process_ = fork();
  if (process_ == 0) {
    setpgid(0, 0);
    Become(program, arguments, toBrowser[0], fromBrowser[1]);
  }
  close(toBrowser[0]);
  close(fromBrowser[1]);
  toBrowser_ = toBrowser[1];
  fromBrowser_ = fromBrowser[0];
  const Json target = Call("Target.createTarget", {{"url", "about:blank"}});
  session_ = Call("Target.attachToTarget", {{"targetId", target["targetId"]}, {"flatten", true}})["sessionId"];
  for (const char* domain : {"Page", "Runtime", "Log", "Network"}) Call(std::string(domain) + ".enable");
  Call("Page.bringToFront");  // pages in the background are painted when it suits the browser
  SetSize(width, height);
}

Browser::~Browser() {
  close(toBrowser_);
  close(fromBrowser_);
  if (process_ > 0) {
    kill(-process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
}

Json Browser::Call(const std::string& method, const Json& params) {
  Json message = {{"id", ++lastId_}, {"method", method}, {"params", params}};
  if (!session_.empty()) message["sessionId"] = session_;
  const std::string text = message.dump();
  size_t written = 0;
  while (written <= text.size()) {  // the zero byte at the end too
    const ssize_t count = write(toBrowser_, text.c_str() + written, text.size() + 1 - written);
    if (count <= 0) throw std::runtime_error("the browser has ended");
    written += static_cast<size_t>(count);
  }
  while (true) {
    const Json answer = Receive();
    if (answer.value("id", 0) != lastId_) continue;
    if (answer.contains("error")) throw std::runtime_error(method + ": " + answer["error"].dump());
    return answer["result"];
  }
}

Json Browser::Receive() {
  size_t end;
  while ((end = received_.find('\0')) == std::string::npos) {
    pollfd ready{fromBrowser_, POLLIN, 0};
    if (poll(&ready, 1, kTimeoutMilliseconds) <= 0) throw std::runtime_error("the browser does not answer");
    char buffer[1 << 16];
    const ssize_t count = read(fromBrowser_, buffer, sizeof buffer);
    if (count <= 0) throw std::runtime_error("the browser has ended");
    received_.append(buffer, static_cast<size_t>(count));
  }
  const Json message = Json::parse(received_.substr(0, end));
  received_.erase(0, end + 1);
  if (message.contains("method")) Note(message);
  return message;
}

void Browser::Note(const Json& event) {
  const std::string method = event["method"];
  const Json& params = event["params"];
  if (method == "Page.loadEventFired") isLoaded_ = true;
  if (method == "Runtime.exceptionThrown") complaints_.push_back(params["exceptionDetails"].dump());
  if (method == "Log.entryAdded") complaints_.push_back(params["entry"].dump());
  if (method == "Runtime.consoleAPICalled") complaints_.push_back(params["args"].dump());
  if (method == "Network.requestWillBeSent") requests_.push_back(params["request"]["url"]);
}

void Browser::Open(const std::string& url) {
  isLoaded_ = false;
  Call("Page.navigate", {{"url", url}});
  while (!isLoaded_) Receive();
}

Json Browser::Evaluate(const std::string& expression) {
  const Json result =
      Call("Runtime.evaluate", {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
  if (result.contains("exceptionDetails"))
    throw std::runtime_error(expression + ": " + result["exceptionDetails"].dump());
  return result["result"].value("value", Json());
}

Point Browser::Find(const std::string& selector) {
  const Json place =
      Evaluate("(() => { const e = document.querySelector(" + Json(selector).dump() +
               "); if (!e) return null; e.scrollIntoView({block: 'center', behavior: 'instant'});"
               " const r = e.getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]; })()");
  if (place.is_null()) throw std::runtime_error("nothing on the page is " + selector);
  return {place[0], place[1]};
}

void Browser::Mouse(const std::string& type, const Point& point, int buttons, int clicks) {
  Call("Input.dispatchMouseEvent", {{"type", type},
                                    {"x", point.x},
                                    {"y", point.y},
                                    {"button", type == "mouseMoved" && buttons == 0 ? "none" : "left"},
                                    {"buttons", buttons},
                                    {"clickCount", clicks}});
}

void Browser::MoveTo(const Point& point) { Mouse("mouseMoved", point, 0); }

void Browser::ClickAt(const Point& point, int clicks) {
  MoveTo(point);
  for (int i = 1; i <= clicks; ++i) {
    Mouse("mousePressed", point, 1, i);
    Mouse("mouseReleased", point, 0, i);
  }
}

void Browser::Drag(const Point& from, const Point& to) {
  MoveTo(from);
  Mouse("mousePressed", from, 1, 1);
  Mouse("mouseMoved", {(from.x + to.x) / 2, (from.y + to.y) / 2}, 1);
  Mouse("mouseMoved", to, 1);
  Mouse("mouseReleased", to, 0, 1);
}

void Browser::Wheel(const Point& at, double deltaY) {
  Call("Input.dispatchMouseEvent",
       {{"type", "mouseWheel"}, {"x", at.x}, {"y", at.y}, {"deltaX", 0}, {"deltaY", deltaY}});
}

void Browser::PressKey(const std::string& key) {
  const int code = key == "ArrowLeft" ? 37 : key == "ArrowRight" ? 39 : key == "Home" ? 36 : 35;
  for (const char* type : {"keyDown", "keyUp"})
    Call("Input.dispatchKeyEvent", {{"type", type}, {"key", key}, {"code", key}, {"windowsVirtualKeyCode", code}});
}

void Browser::SetSize(int width, int height) {
  Call("Emulation.setDeviceMetricsOverride",
       {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
}

void Browser::PreferScheme(const std::string& scheme) {
  const Json feature = {{"name", "prefers-color-scheme"}, {"value", scheme}};
  Call("Emulation.setEmulatedMedia", {{"features", Json::array({feature})}});
}

std::string Browser::Screenshot(bool isWholePage) {
  Json params = {{"format", "png"}};
  if (isWholePage) {
    const Json size = Call("Page.getLayoutMetrics")["cssContentSize"];
    params["captureBeyondViewport"] = true;
    params["clip"] = {{"x", 0}, {"y", 0}, {"width", size["width"]}, {"height", size["height"]}, {"scale", 1}};
  }
  return DecodeBase64(Call("Page.captureScreenshot", params)["data"]);
}

}  // namespace dapple::testing_support
