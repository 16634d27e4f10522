# SPDX-License-Identifier: Apache-2.0
"""Packs the program and a module into a wheel; `tools/python/wheel` builds both and calls it.

The wheel holds all shared libraries that they need, except glibc and g++'s runtime library, and the licences of these
libraries. Its platform tag follows from the symbol versions that the files need."""
import base64
import hashlib
import os
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
import zipfile

# Libraries that a wheel may load from the system (PEP 600).
OF_SYSTEM = {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "librt.so.1", "libgcc_s.so.1", "libstdc++.so.6",
             "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"}
# Libraries that a wheel may hold: their licences allow it, and none of them opens connections.
INSIDE = {"Imath", "aec", "blosc", "boost_iostreams", "bz2", "deflate", "hdf5_serial", "log4cplus", "lz4", "lzma", "openvdb",
          "pugixml", "scotch", "scotcherr", "snappy", "sz", "tbb", "tbbmalloc", "tiff", "z", "zip", "zstd"}
# Debian packages whose headers or scripts are compiled into the program and the module.
HEADERS = ["libcli11-dev", "libeigen3-dev", "libjs-three", "nlohmann-json3-dev"]
# The oldest glibc that distributions combine with these versions of g++'s runtime library.
GLIBC_BESIDE = {"GLIBCXX": {"3.4.19": "2.17", "3.4.29": "2.34", "3.4.30": "2.35", "3.4.33": "2.39"},
                "CXXABI": {"1.3.7": "2.17", "1.3.13": "2.34", "1.3.15": "2.39"},
                "GCC": {"4.8.0": "2.17", "7.0.0": "2.34", "12.0.0": "2.35", "14.0.0": "2.39"}}
LARGEST_WHEEL = 40 * 1024**2


def numbers(version):
    return tuple(int(n) for n in version.split("."))


def output_of(*command, **environment):
    return subprocess.run([str(c) for c in command], capture_output=True, text=True, check=True,
                          env={**os.environ, **environment}).stdout


def stem(library):
    """Strips "lib" and versions from a file name: libImath-3_1.so.29 is Imath."""
    return re.sub(r"-[0-9][0-9_.]*$", "", library.removeprefix("lib").split(".so")[0])


def needed_libraries(file, first_folder=""):
    """Maps the names of all libraries that the file needs, directly or not, to their paths. Libraries in the folder take
    precedence over the system's."""
    libraries = {}
    for line in output_of("ldd", file, LD_LIBRARY_PATH=str(first_folder)).splitlines():
        name, arrow, path = line.strip().partition(" => ")
        if not re.search(r"\(0x\w+\)$", line):
            sys.exit(f"ldd of {file}: {line.strip()}")
        if arrow and name not in OF_SYSTEM:
            libraries[name] = pathlib.Path(path.split(" (")[0])
    return libraries


def check_inside(libraries, file):
    for name, path in libraries.items():
        if stem(name) not in INSIDE:
            sys.exit(f"{file} needs {name} ({path}), which a wheel must not have inside; build without it, or add it "
                     "to INSIDE in tools/python/wheel_contents.py")


def compiled_files(folder):
    return [f for f in sorted(folder.rglob("*")) if f.is_file() and f.read_bytes()[:4] == b"\x7fELF"]


def symbol_versions(file):
    """Returns the symbol versions that the file needs from the system's libraries, such as GLIBC_2.34."""
    versions = set()
    library = None
    for line in output_of("objdump", "-p", file).splitlines():
        if heading := re.match(r"  required from (\S+):", line):
            library = heading[1]
        elif entry := re.match(r"    0x\w+ 0x\w+ \d+ (\S+)", line):
            if library in OF_SYSTEM:
                versions.add(entry[1])
        else:
            library = None
    return versions


def platform_tag(versions, machine):
    """Returns the tag of the oldest systems that have all of these symbol versions."""
    glibc = "2.17"
    for version in versions:
        library, _, number = version.rpartition("_")
        if version == "GLIBC_ABI_DT_RELR":
            needed = "2.36"
        elif version in ("CXXABI_FLOAT128", "CXXABI_TM_1"):
            continue
        elif library not in ("GLIBC", *GLIBC_BESIDE) or not re.fullmatch(r"[0-9.]+", number):
            sys.exit(f"which systems have {version} is not known; add it to tools/python/wheel_contents.py")
        elif library == "GLIBC":
            needed = number
        else:
            beside = [g for v, g in GLIBC_BESIDE[library].items() if numbers(number) <= numbers(v)]
            if not beside:
                sys.exit(f"which glibc comes with {version} is not known; add it to GLIBC_BESIDE in "
                         "tools/python/wheel_contents.py")
            needed = beside[0]
        glibc = max(glibc, ".".join(needed.split(".")[:2]), key=numbers)
    return f"manylinux_{glibc.replace('.', '_')}_{machine}"


def licence_of_package(package):
    """Returns the source package with its version, and the licence, of an installed package."""
    return (output_of("dpkg-query", "-W", "-f", "${source:Package} ${source:Version}", package),
            pathlib.Path(f"/usr/share/doc/{package}/copyright").read_text(errors="replace"))


def licence_of_library(path, parts):
    """Returns the package of a library, its source and its licence."""
    if parts in path.parents:
        for file in (parts / "libraries" / "licences").iterdir():
            if stem(path.name).startswith(file.name.removeprefix("lib")):
                return file.name, file.read_text().split(",")[0], file.read_text()
    real = path.resolve()
    # Debian 12 lists some files of /usr/lib under /lib.
    owners = [line.split(":")[0] for line in output_of("dpkg-query", "-S", "*/" + real.name).splitlines()
              if str(real).endswith(line.split(": ")[1])]
    return owners[0], *licence_of_package(owners[0])


def write_licences(licences, folder):
    """Writes the licence of each package, and the common licences to which these refer."""
    common = set()
    for package, text in licences.items():
        (folder / package).mkdir(parents=True)
        (folder / package / "copyright").write_text(text)
        common |= set(re.findall(r"/usr/share/common-licenses/([\w.-]*\w)", text))
    for name in common:
        if (file := pathlib.Path("/usr/share/common-licenses", name)).exists():
            (folder / "common-licenses").mkdir(exist_ok=True)
            shutil.copyfile(file, folder / "common-licenses" / name)


def add_libraries(libraries, folder):
    """Copies libraries into the folder and returns their new names. A hash in the name keeps the loader from taking another
    library of the process for one of these."""
    folder.mkdir()
    new_names = {}
    for name, path in sorted(libraries.items()):
        before, so, after = name.partition(".so")
        digest = hashlib.sha256(path.read_bytes()).hexdigest()[:8]
        # The name must stay: oneTBB loads its allocator by name.
        new_names[name] = name if stem(name) == "tbbmalloc" else f"{before}-{digest}{so}{after}"
        shutil.copyfile(path, folder / new_names[name])
    return new_names


def settle(file, new_names, run_path):
    """Makes a file find its libraries in the wheel."""
    file.chmod(0o755)
    subprocess.run(["strip", "--strip-unneeded", file], check=True)
    replaced = [word for needed in output_of("patchelf", "--print-needed", file).split() if needed in new_names
                for word in ("--replace-needed", needed, new_names[needed])]
    # Make each change in a separate call: patchelf 0.14 loses the new names if it also sets the path.
    for change in (["--set-rpath", run_path], replaced, ["--set-soname", file.name] if ".so." in file.name else []):
        if change:
            subprocess.run(["patchelf", *change, file], check=True)


def check_linkage(folder):
    """Exits if a file would load a library from outside the folder that is not in OF_SYSTEM."""
    for file in compiled_files(folder):
        for name, path in needed_libraries(file).items():
            if folder not in path.resolve().parents:
                sys.exit(f"{file.relative_to(folder)} would take {name} from the system")


def metadata(source):
    """Returns name, version and METADATA of the wheel, as given by pyproject.toml."""
    project = tomllib.loads((source / "pyproject.toml").read_text())["project"]
    known = {"name": "Name", "version": "Version", "description": "Summary", "requires-python": "Requires-Python"}
    if unknown := set(project) - set(known) - {"license", "readme", "dependencies"}:
        sys.exit(f"tools/python/wheel_contents.py does not know these entries of pyproject.toml: {', '.join(unknown)}")
    lines = ["Metadata-Version: 2.1", *(f"{known[k]}: {project[k]}" for k in project if k in known),
             f"License: {project['license']['text']}", *(f"Requires-Dist: {d}" for d in project["dependencies"]),
             "Description-Content-Type: text/markdown"]
    return project["name"], project["version"], "\n".join(lines) + "\n\n" + (source / project["readme"]).read_text()


def write_wheel(folder, dist_info, file):
    """Writes the wheel with its RECORD. Equal contents give equal bytes."""
    record = []
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        def add(name, content, mode):
            entry = zipfile.ZipInfo(name)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o100000 | mode) << 16
            archive.writestr(entry, content)
        for path in sorted(p for p in folder.rglob("*") if p.is_file()):
            content = path.read_bytes()
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            name = path.relative_to(folder).as_posix()
            record.append(f"{name},sha256={digest},{len(content)}\n")
            add(name, content, 0o755 if path.stat().st_mode & 0o100 else 0o644)
        add(f"{dist_info}/RECORD", "".join(record) + f"{dist_info}/RECORD,,\n", 0o644)


def make(build, python, parts, output):
    source = pathlib.Path(__file__).resolve().parents[2]
    module = build / "wheel" / f"python{python}" / "_core.so"
    program = build / "bin" / "tetwright"
    machine = platform.machine()
    cpython = python.replace(".", "")
    libraries = {}
    for file in (program, module):
        found = needed_libraries(file, parts / "libraries" / "lib")
        check_inside(found, file)
        libraries |= found
    # oneTBB loads its allocator itself if both are in one folder.
    libraries["libtbbmalloc.so.2"] = libraries["libtbb.so.12"].with_name("libtbbmalloc.so.2")

    name, version, described = metadata(source)
    dist_info = f"{name}-{version}.dist-info"
    with tempfile.TemporaryDirectory() as folder_name:
        folder = pathlib.Path(folder_name).resolve()
        no_caches = shutil.ignore_patterns("__pycache__")
        package = shutil.copytree(source / "tools/python/tetwright", folder / "tetwright", ignore=no_caches)
        shutil.copytree(source / "tools/python/wheel_program", folder / "tetwright_program", ignore=no_caches)
        new_names = add_libraries(libraries, folder / "tetwright.libs")
        shutil.copy(module, package / f"_core.cpython-{cpython}-{machine}-linux-gnu.so")
        shutil.copy(program, folder / "tetwright_program")
        for file in compiled_files(folder):
            settle(file, new_names, "$ORIGIN" if file.parent.name == "tetwright.libs" else "$ORIGIN/../tetwright.libs")
        check_linkage(folder)
        versions = set().union(*map(symbol_versions, compiled_files(folder)))
        tag = f"cp{cpython}-cp{cpython}-{platform_tag(versions, machine)}"

        information = folder / dist_info
        licences = {}
        listing = ["Code of others in this wheel, the package of Debian that it is of, and the source of that:"]
        for library, path in libraries.items():
            owner, owner_source, licences[owner] = licence_of_library(path, parts)
            listing.append(f"{new_names[library]}: {owner}, {owner_source}")
        for owner in HEADERS:
            owner_source, licences[owner] = licence_of_package(owner)
            listing.append(f"headers: {owner}, {owner_source}")
        licences["pybind11-dev"] = (parts / "pybind11/usr/share/doc/pybind11-dev/copyright").read_text()
        pybind11_version = output_of("dpkg-deb", "-f", *(parts / "pybind11").glob("*.deb"), "Version").strip()
        listing.append(f"headers: pybind11-dev, pybind11 {pybind11_version}")
        write_licences(licences, information / "licenses")
        shutil.copyfile(source / "LICENSE", information / "licenses" / "LICENSE")
        (information / "licenses" / "bundled.txt").write_text("\n".join(listing) + "\n")
        (information / "METADATA").write_text(described)
        (information / "WHEEL").write_text("Wheel-Version: 1.0\nGenerator: tools/python/wheel\nRoot-Is-Purelib: false\n"
                                           f"Tag: {tag}\n")
        (information / "entry_points.txt").write_text("[console_scripts]\ntetwright = tetwright_program:main\n")
        (information / "top_level.txt").write_text("tetwright\ntetwright_program\n")

        for old in output.glob(f"{name}-*-cp{cpython}-*.whl"):
            old.unlink()
        file = output / f"{name}-{version}-{tag}.whl"
        write_wheel(folder, dist_info, file)
    if file.stat().st_size > LARGEST_WHEEL:
        sys.exit(f"{file} has {file.stat().st_size} bytes, more than {LARGEST_WHEEL}")
    print(file.resolve(), f"{file.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    build_folder, python_version, parts_folder, output_folder = sys.argv[1:]
    make(pathlib.Path(build_folder), python_version, pathlib.Path(parts_folder), pathlib.Path(output_folder))
