#define EGL_NO_X11
#include "viewer/context/backends.hpp"
#include "viewer/context/shared_library.hpp"

#include <cstdlib>
#include <cstring>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

namespace tumble {
namespace {

struct Egl {
  decltype(eglGetProcAddress)* get_proc_address = nullptr;
  decltype(eglGetError)* get_error = nullptr;
  decltype(eglQueryString)* query_string = nullptr;
  decltype(eglInitialize)* initialize = nullptr;
  decltype(eglBindAPI)* bind_api = nullptr;
  decltype(eglChooseConfig)* choose_config = nullptr;
  decltype(eglCreateContext)* create_context = nullptr;
  decltype(eglDestroyContext)* destroy_context = nullptr;
  decltype(eglMakeCurrent)* make_current = nullptr;
  PFNEGLGETPLATFORMDISPLAYEXTPROC get_platform_display = nullptr;
  PFNEGLQUERYDEVICESEXTPROC query_devices = nullptr;
  PFNEGLQUERYDEVICESTRINGEXTPROC query_device_string = nullptr;
  std::string client_extensions;
};

bool has_word(const char* list, const char* word) {
  const size_t length = std::strlen(word);
  for (const char* p = list; p && (p = std::strstr(p, word)); p += length)
    if ((p == list || p[-1] == ' ') && (p[length] == ' ' || p[length] == 0)) return true;
  return false;
}

/// What to do if EGL offers nothing usable. Environment variables known to break it are named
/// first, since they are quickest to check.
std::string driver_cure() {
  std::string cure;
  for (const char* name : {"LIBGL_DRIVERS_PATH", "__EGL_VENDOR_LIBRARY_DIRS",
                           "__EGL_VENDOR_LIBRARY_FILENAMES", "GBM_BACKENDS_PATH"})
    if (const char* value = std::getenv(name))
      cure += fmt::format("unset {} (it is '{}'), or ", name, value);
  return cure + "install a driver: apt install libegl1 libgl1-mesa-dri";
}

Result<Egl> load_egl() {
  auto library = SharedLibrary::open("libEGL.so.1", "apt install libegl1 libgl1-mesa-dri");
  if (!library) return library.error();
  Egl e;
  const bool complete = library->find("eglGetProcAddress", e.get_proc_address) &&
                        library->find("eglGetError", e.get_error) &&
                        library->find("eglQueryString", e.query_string) &&
                        library->find("eglInitialize", e.initialize) &&
                        library->find("eglBindAPI", e.bind_api) &&
                        library->find("eglChooseConfig", e.choose_config) &&
                        library->find("eglCreateContext", e.create_context) &&
                        library->find("eglDestroyContext", e.destroy_context) &&
                        library->find("eglMakeCurrent", e.make_current);
  if (!complete)
    return Error{ErrorCode::unsupported, "not an EGL 1.4 library", "libEGL.so.1",
                 "reinstall it: apt install --reinstall libegl1"};
  const auto extension = [&](const char* name) { return e.get_proc_address(name); };
  e.get_platform_display =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(extension("eglGetPlatformDisplayEXT"));
  e.query_devices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(extension("eglQueryDevicesEXT"));
  e.query_device_string =
      reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(extension("eglQueryDeviceStringEXT"));
  const char* client = e.query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  e.client_extensions = client ? client : "";
  return e;
}

Result<std::vector<EGLDeviceEXT>> query_devices(const Egl& e) {
  const char* list = e.client_extensions.c_str();
  if (!e.query_devices || !e.get_platform_display ||
      !(has_word(list, "EGL_EXT_device_base") || has_word(list, "EGL_EXT_device_enumeration")))
    return Error{ErrorCode::unsupported, "EGL cannot list devices", "libEGL.so.1", driver_cure()};
  EGLint count = 0;
  if (!e.query_devices(0, nullptr, &count) || count <= 0)
    return Error{ErrorCode::unsupported, "EGL lists no device: no driver is registered",
                 "libEGL.so.1", driver_cure()};
  std::vector<EGLDeviceEXT> devices(static_cast<size_t>(count));
  e.query_devices(count, devices.data(), &count);
  devices.resize(static_cast<size_t>(count));
  return devices;
}

std::string device_detail(const Egl& e, EGLDeviceEXT device) {
  if (!e.query_device_string) return "";
  const char* extensions = e.query_device_string(device, EGL_EXTENSIONS);
  if (has_word(extensions, "EGL_EXT_device_drm_render_node"))
    if (const char* file = e.query_device_string(device, EGL_DRM_RENDER_NODE_FILE_EXT)) return file;
  if (has_word(extensions, "EGL_EXT_device_drm"))
    if (const char* file = e.query_device_string(device, EGL_DRM_DEVICE_FILE_EXT)) return file;
  if (has_word(extensions, "EGL_MESA_device_software")) return "software device";
  return "";
}

class EglContext final : public GlContext {
 public:
  EglContext(Egl egl, EGLDisplay display, ContextInfo info)
      : egl_(std::move(egl)), display_(display), info_(std::move(info)) {}
  // The display stays initialised, because all contexts of the process share it.
  ~EglContext() override {
    if (context_ == EGL_NO_CONTEXT) return;
    release();
    egl_.destroy_context(display_, context_);
  }

  Status open() {
    EGLint major = 0, minor = 0;
    if (!egl_.initialize(display_, &major, &minor)) return fault("eglInitialize failed");
    if (!egl_.bind_api(EGL_OPENGL_API)) return fault("EGL without OpenGL");
    const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!egl_.choose_config(display_, wanted, &config, 1, &count) || count < 1)
      return fault("no configuration for OpenGL");
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION_KHR,
                              3,
                              EGL_CONTEXT_MINOR_VERSION_KHR,
                              3,
                              EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR,
                              EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR,
                              EGL_NONE};
    context_ = egl_.create_context(display_, config, EGL_NO_CONTEXT, version);
    if (context_ == EGL_NO_CONTEXT) return fault("no OpenGL 3.3 core context");
    if (Status s = make_current(); !s) return s;
    return describe_current(*this, info_);
  }

  const ContextInfo& info() const override { return info_; }
  Status make_current() override {
    // EGL does nothing where this context is current already as far as it knows; it does not know
    // of a context of OSMesa that has taken its place.
    release();
    if (!egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
      return fault("the context cannot be made current without a surface");
    return {};
  }
  void release() override {
    egl_.bind_api(EGL_OPENGL_API);  // the API bound to the thread decides which context is released
    egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  Function get_proc_address(const char* name) const override {
    return reinterpret_cast<Function>(egl_.get_proc_address(name));
  }

 private:
  Error fault(const char* what) const {
    return Error{
        ErrorCode::unsupported,
        fmt::format("{} (EGL error 0x{:04X})", what, static_cast<unsigned>(egl_.get_error())),
        info_.detail.empty() ? info_.name : info_.name + " " + info_.detail,
        info_.detail.rfind("/dev/", 0) == 0
            ? "check that you may open the device (group render), or " + driver_cure()
            : driver_cure()};
  }

  Egl egl_;
  EGLDisplay display_;
  EGLContext context_ = EGL_NO_CONTEXT;
  ContextInfo info_;
};

Result<std::unique_ptr<GlContext>> open_context(const Egl& e, EGLenum platform, void* native,
                                                const EglPlace& place) {
  EGLDisplay display = e.get_platform_display(platform, native, nullptr);
  if (display == EGL_NO_DISPLAY)
    return Error{ErrorCode::unsupported, "EGL gives no display for this device",
                 place.name + " " + place.detail, driver_cure()};
  ContextInfo info;
  info.name = place.name;
  info.detail = place.detail;
  auto context = std::make_unique<EglContext>(e, display, info);
  if (Status s = context->open(); !s) return s.error();
  return std::unique_ptr<GlContext>(std::move(context));
}

EglPlace place_of(const Egl& e, EGLDeviceEXT device, size_t index) {
  return {fmt::format("egl:{}", index), device_detail(e, device)};
}

}  // namespace

Result<std::vector<EglPlace>> egl_devices() {
  auto egl = load_egl();
  if (!egl) return egl.error();
  auto devices = query_devices(*egl);
  if (!devices) return devices.error();
  std::vector<EglPlace> places;
  for (size_t i = 0; i < devices->size(); ++i) places.push_back(place_of(*egl, (*devices)[i], i));
  return places;
}

Result<std::unique_ptr<GlContext>> make_egl_device_context(size_t device) {
  auto egl = load_egl();
  if (!egl) return egl.error();
  auto devices = query_devices(*egl);
  if (!devices) return devices.error();
  if (device >= devices->size())
    return Error{ErrorCode::invalid_argument,
                 fmt::format("there are {} EGL devices, numbered from 0", devices->size()),
                 fmt::format("egl:{}", device), "tumble doctor lists them"};
  EGLDeviceEXT chosen = (*devices)[device];
  return open_context(*egl, EGL_PLATFORM_DEVICE_EXT, chosen, place_of(*egl, chosen, device));
}

Result<std::unique_ptr<GlContext>> make_egl_surfaceless_context() {
  auto egl = load_egl();
  if (!egl) return egl.error();
  if (!egl->get_platform_display ||
      !has_word(egl->client_extensions.c_str(), "EGL_MESA_platform_surfaceless"))
    return Error{ErrorCode::unsupported, "EGL lacks EGL_MESA_platform_surfaceless", "surfaceless",
                 driver_cure()};
  return open_context(*egl, EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY,
                      {"surfaceless", "EGL_MESA_platform_surfaceless"});
}

}  // namespace tumble
