//! Arguments of the linker, on systems that need any.

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}
