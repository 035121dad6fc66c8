// Drops a file on the first window that takes drops, as a file manager does (XDND version 5,
// https://freedesktop.org/wiki/Specifications/XDND). usage: xdnd_drop FILE
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>

#include <X11/Xatom.h>
#include <X11/Xlib.h>

namespace {

struct Atoms {
  Atom aware, enter, position, status, drop, finished, selection, copy, uri_list;
  explicit Atoms(Display* d) {
    const auto atom = [d](const char* name) { return XInternAtom(d, name, False); };
    aware = atom("XdndAware");
    enter = atom("XdndEnter");
    position = atom("XdndPosition");
    status = atom("XdndStatus");
    drop = atom("XdndDrop");
    finished = atom("XdndFinished");
    selection = atom("XdndSelection");
    copy = atom("XdndActionCopy");
    uri_list = atom("text/uri-list");
  }
};

Window find_aware(Display* d, const Atoms& atoms, Window at) {
  Atom type = 0;
  int format = 0;
  unsigned long count = 0, rest = 0;
  unsigned char* data = nullptr;
  XGetWindowProperty(d, at, atoms.aware, 0, 1, False, AnyPropertyType, &type, &format, &count,
                     &rest, &data);
  if (data) XFree(data);
  if (type != None) return at;
  Window root = 0, parent = 0, found = 0, *children = nullptr;
  unsigned int n = 0;
  if (!XQueryTree(d, at, &root, &parent, &children, &n)) return 0;
  for (unsigned int i = 0; i < n && !found; ++i) found = find_aware(d, atoms, children[i]);
  if (children) XFree(children);
  return found;
}

void tell(Display* d, Window to, Window from, Atom what, long a, long b, long c, long e) {
  XEvent event;
  std::memset(&event, 0, sizeof event);
  event.xclient.type = ClientMessage;
  event.xclient.window = to;
  event.xclient.message_type = what;
  event.xclient.format = 32;
  const long values[5] = {long(from), a, b, c, e};
  std::memcpy(event.xclient.data.l, values, sizeof values);
  XSendEvent(d, to, False, NoEventMask, &event);
  XFlush(d);
}

void answer(Display* d, const XSelectionRequestEvent& request, const std::string& uri) {
  XChangeProperty(d, request.requestor, request.property, request.target, 8, PropModeReplace,
                  reinterpret_cast<const unsigned char*>(uri.data()), int(uri.size()));
  XEvent event;
  std::memset(&event, 0, sizeof event);
  event.xselection.type = SelectionNotify;
  event.xselection.requestor = request.requestor;
  event.xselection.selection = request.selection;
  event.xselection.target = request.target;
  event.xselection.property = request.property;
  event.xselection.time = request.time;
  XSendEvent(d, request.requestor, False, NoEventMask, &event);
  XFlush(d);
}

}  // namespace

int main(int argc, char** argv) {
  Display* d = argc == 2 ? XOpenDisplay(nullptr) : nullptr;
  char* path = d ? realpath(argv[1], nullptr) : nullptr;
  if (!path) return 2;
  const std::string uri = std::string("file://") + path + "\r\n";
  std::free(path);
  const Atoms atoms(d);
  const Window target = find_aware(d, atoms, DefaultRootWindow(d));
  if (!target) return 3;
  const Window self = XCreateSimpleWindow(d, DefaultRootWindow(d), 0, 0, 1, 1, 0, 0, 0);
  XSetSelectionOwner(d, atoms.selection, self, CurrentTime);
  tell(d, target, self, atoms.enter, 5L << 24, long(atoms.uri_list), None, None);
  tell(d, target, self, atoms.position, 0, 600L << 16 | 400, CurrentTime, long(atoms.copy));
  for (int waited = 0; waited < 2000; ++waited) {
    while (XPending(d) > 0) {
      XEvent event;
      XNextEvent(d, &event);
      if (event.type == SelectionRequest) answer(d, event.xselectionrequest, uri);
      if (event.type != ClientMessage) continue;
      if (event.xclient.message_type == atoms.status) {
        if (!(event.xclient.data.l[1] & 1)) return 4;  // not wanted
        tell(d, target, self, atoms.drop, 0, CurrentTime, 0, 0);
      }
      if (event.xclient.message_type == atoms.finished) return 0;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return 5;
}
