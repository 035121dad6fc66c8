#pragma once
#include "engine/core/log.hpp"
#include "engine/core/result.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// The implementation on which a context runs.
struct ContextInfo {
  std::string name;      ///< as --context takes it: "egl:0", "surfaceless", "osmesa", "window"
  std::string detail;    ///< device file or extension, if known: "/dev/dri/renderD128"
  std::string renderer;  ///< GL_RENDERER
  std::string vendor;
  std::string version;  ///< GL_VERSION
  bool software = false;
};

/// An OpenGL 3.3 core context, current on at most one thread at a time. Everything is drawn into
/// our own framebuffers; only a window also has a framebuffer of its own.
class GlContext {
 public:
  using Function = void (*)();

  virtual ~GlContext() = default;
  virtual const ContextInfo& info() const = 0;
  /// Binds the context to the calling thread.
  virtual Status make_current() = 0;
  /// Unbinds it, so that another thread may take it.
  virtual void release() = 0;
  /// Address of the GL function with this name, or null.
  virtual Function get_proc_address(const char* name) const = 0;
};

/// An attempt with one backend, and its outcome.
struct ContextAttempt {
  std::string name;
  bool ok = false;
  Error error;  ///< if not ok
};

struct ContextChoice {
  std::unique_ptr<GlContext> context;    ///< current on the calling thread
  std::vector<ContextAttempt> attempts;  ///< in the order tried; the last is the one chosen
};

/// Makes a context by name: `auto` (each EGL device, surfaceless, OSMesa, in that order), `egl`
/// (first EGL device that works), `egl:N`, `egl:NAME` (first EGL device whose file, vendor or
/// renderer contains NAME, ignoring case; see `tumble doctor`), `surfaceless`, `osmesa`, `window`
/// (a hidden one). The choice, and why earlier attempts failed, are logged. The error lists every
/// attempt with its cause and cure.
Result<ContextChoice> create_context(std::string_view name, const LogSink& log = {});

/// An error for a name of no form that create_context understands; whether the device of an
/// egl:NAME exists is only known by looking.
Status check_context_name(std::string_view name);

/// Names that create_context understands, for help and messages.
const std::vector<std::string>& context_names();

}  // namespace tumble
