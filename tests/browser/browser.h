// A headless Chromium that a test drives: it opens pages, clicks and moves as a person does, and tells what is shown.
//
// Speaks the DevTools protocol over two pipes (--remote-debugging-pipe): messages of JSON, each ended by a zero byte.
// No network is needed, and none is used.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <sys/types.h>

namespace dapple::testing_support {

/// The program's path, or empty where there is none.
std::string FindChromium();

struct Point {
  double x = 0, y = 0;
};

class Browser {
 public:
  /// Starts `program` with one empty page of that size; throws std::runtime_error where it does not answer.
  Browser(const std::string& program, const std::string& profileFolder, int width, int height);
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  /// Opens a page and waits until it is loaded.
  void Open(const std::string& url);
  /// The value of a JavaScript expression. Throws where it throws.
  nlohmann::json Evaluate(const std::string& expression);
  /// The middle of the first element that the selector finds, in the window; it is scrolled into view.
  Point Find(const std::string& selector);

  void MoveTo(const Point& point);
  void ClickAt(const Point& point, int clicks = 1);
  void Click(const std::string& selector) { ClickAt(Find(selector)); }
  void Drag(const Point& from, const Point& to);
  void Wheel(const Point& at, double deltaY);
  void PressKey(const std::string& key);

  void SetSize(int width, int height);
  /// What the system prefers: "light" or "dark".
  void PreferScheme(const std::string& scheme);
  /// A PNG file of the window, or of the whole page.
  std::string Screenshot(bool isWholePage);

  /// What the console and exceptions told since they were last taken; empty where all is well.
  std::vector<std::string> TakeComplaints() { return std::exchange(complaints_, {}); }
  /// What the page asked for: of a self-contained page nothing but itself and what it holds.
  std::vector<std::string> TakeRequests() { return std::exchange(requests_, {}); }

 private:
  nlohmann::json Call(const std::string& method, const nlohmann::json& params = nlohmann::json::object());
  nlohmann::json Receive();
  void Note(const nlohmann::json& event);
  void Mouse(const std::string& type, const Point& point, int buttons, int clicks = 0);

  pid_t process_ = -1;
  int toBrowser_ = -1, fromBrowser_ = -1;
  int lastId_ = 0;
  std::string session_, received_;
  bool isLoaded_ = false;
  std::vector<std::string> complaints_, requests_;
};

}  // namespace dapple::testing_support
