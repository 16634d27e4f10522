# SPDX-License-Identifier: Apache-2.0
"""Tests the parts of tools/python/wheel that need no separate build; tools/python/try_wheel tests complete wheels."""
import base64
import hashlib
import os
import pathlib
import shutil
import subprocess
import sys
import zipfile

import pytest

SOURCE = pathlib.Path(os.environ["TETWRIGHT_SOURCE"])
sys.path.insert(0, str(SOURCE / "tools/python"))
import wheel_contents  # noqa: E402


@pytest.mark.parametrize("versions, tag", [
    ({"GLIBC_2.2.5", "GCC_3.0"}, "manylinux_2_17_x86_64"),
    ({"GLIBC_2.2.5", "GLIBC_2.34", "GLIBC_2.4"}, "manylinux_2_34_x86_64"),
    ({"GLIBC_2.2.5", "GLIBC_2.34", "GLIBCXX_3.4.30"}, "manylinux_2_35_x86_64"),
    ({"GLIBC_2.34", "GLIBC_ABI_DT_RELR", "CXXABI_1.3.9"}, "manylinux_2_36_x86_64"),
    ({"GLIBC_2.38", "GLIBCXX_3.4.21", "CXXABI_FLOAT128"}, "manylinux_2_38_x86_64"),
    ({"GLIBC_2.34", "CXXABI_1.3.15"}, "manylinux_2_39_x86_64"),
    ({"GLIBC_2.41", "GLIBCXX_3.4.33"}, "manylinux_2_41_x86_64")])
def test_the_tag_is_that_of_the_oldest_systems_with_all_versions_of_symbols(versions, tag):
    assert wheel_contents.platform_tag(versions, "x86_64") == tag


@pytest.mark.parametrize("version", ["GLIBC_PRIVATE", "GLIBCXX_3.4.99", "OPENSSL_3.0.0"])
def test_versions_of_symbols_of_which_no_system_is_known_are_refused(version):
    with pytest.raises(SystemExit, match=version):
        wheel_contents.platform_tag({"GLIBC_2.34", version}, "x86_64")


@pytest.mark.parametrize("file, stem", [
    ("libImath-3_1.so.29", "Imath"), ("liblog4cplus-2.0.so.3", "log4cplus"), ("libboost_iostreams.so.1.74.0", "boost_iostreams"),
    ("libbz2.so.1.0", "bz2"), ("libopenvdb.so.10.0", "openvdb"), ("libhdf5_serial.so.103", "hdf5_serial"), ("libldap-2.5.so.0", "ldap")])
def test_libraries_are_known_without_their_versions(file, stem):
    assert wheel_contents.stem(file) == stem


def test_a_program_that_takes_more_than_a_wheel_may_have_is_refused(tmp_path):
    program = os.environ["TETWRIGHT_PROGRAM"]  # with Debian's HDF5, which has a driver for files on the network
    libraries = wheel_contents.needed_libraries(program, tmp_path)
    assert not {"libc.so.6", "libstdc++.so.6"} & set(libraries)
    with pytest.raises(SystemExit, match="must not have inside"):
        wheel_contents.check_inside(libraries, program)
    unwanted = {name for name in libraries if wheel_contents.stem(name) not in wheel_contents.INSIDE}
    assert {"libcurl", "libcrypto"} <= {name.split(".")[0] for name in unwanted}
    wheel_contents.check_inside({name: path for name, path in libraries.items() if name not in unwanted}, program)


def test_libraries_of_the_folder_are_taken_before_the_systems(tmp_path):
    program = os.environ["TETWRIGHT_PROGRAM"]
    libraries = wheel_contents.needed_libraries(program, tmp_path)
    name = next(n for n in libraries if wheel_contents.stem(n) == "tbb")
    shutil.copy(libraries[name], tmp_path)
    assert wheel_contents.needed_libraries(program, tmp_path)[name] == tmp_path / name


def test_a_file_that_would_take_a_library_from_the_system_is_refused(tmp_path):
    wheel_contents.check_linkage(tmp_path)
    shutil.copy(os.environ["TETWRIGHT_PROGRAM"], tmp_path)
    with pytest.raises(SystemExit, match=r"would take lib\w+"):
        wheel_contents.check_linkage(tmp_path)


def test_versions_are_those_of_the_systems_libraries_alone():
    versions = wheel_contents.symbol_versions(os.environ["TETWRIGHT_PROGRAM"])
    assert "GLIBC_2.2.5" in versions or "GLIBC_2.17" in versions
    assert {v.split("_")[0] for v in versions} <= {"GLIBC", "GLIBCXX", "CXXABI", "GCC"}


def test_licences_are_found_with_the_common_ones_that_they_name(tmp_path):
    libraries = wheel_contents.needed_libraries(os.environ["TETWRIGHT_PROGRAM"], tmp_path)
    name = next(n for n in libraries if wheel_contents.stem(n) == "tbb")
    package, source, text = wheel_contents.licence_of_library(libraries[name], tmp_path)
    assert package.startswith("libtbb") and source.startswith("onetbb ") and "Apache" in text
    wheel_contents.write_licences({package: text}, tmp_path / "licenses")
    assert (tmp_path / "licenses" / package / "copyright").read_text() == text
    assert "Apache License" in (tmp_path / "licenses/common-licenses/Apache-2.0").read_text()


def test_the_wheel_says_of_itself_what_pyproject_says():
    name, version, text = wheel_contents.metadata(SOURCE)
    head, _, description = text.partition("\n\n")
    assert {"Name: tetwright", f"Version: {version}", "Requires-Dist: numpy", "License: Apache-2.0"} <= set(head.splitlines())
    assert name == "tetwright" and description == (SOURCE / "README.md").read_text()


def test_a_wheel_lists_its_files_and_keeps_what_may_be_run(tmp_path):
    folder = tmp_path / "content"
    (folder / "package").mkdir(parents=True)
    (folder / "package/text").write_bytes(b"text")
    (folder / "package/program").write_bytes(b"#!/bin/sh\n")
    (folder / "package/program").chmod(0o755)
    for file in ("first.whl", "second.whl"):
        wheel_contents.write_wheel(folder, "a-1.dist-info", tmp_path / file)
    assert (tmp_path / "first.whl").read_bytes() == (tmp_path / "second.whl").read_bytes()
    with zipfile.ZipFile(tmp_path / "first.whl") as wheel:
        modes = {entry.filename: entry.external_attr >> 16 for entry in wheel.infolist()}
        record = wheel.read("a-1.dist-info/RECORD").decode().splitlines()
    assert modes["package/program"] == 0o100755 and modes["package/text"] == 0o100644
    digest = base64.urlsafe_b64encode(hashlib.sha256(b"text").digest()).decode().rstrip("=")
    assert f"package/text,sha256={digest},4" in record and len(record) == len(modes)


def test_the_script_of_a_wheel_becomes_the_program(tmp_path):
    folder = shutil.copytree(SOURCE / "tools/python/wheel_program", tmp_path / "tetwright_program")
    (folder / "tetwright").write_text('#!/bin/sh\ngrep SigIgn /proc/$$/status\necho "$$" "$@"\nexit 3\n')
    (folder / "tetwright").chmod(0o755)
    child = subprocess.Popen([sys.executable, "-c", "from tetwright_program import main; main()", "check", "a file"],
                             stdout=subprocess.PIPE, text=True, env={**os.environ, "PYTHONPATH": str(tmp_path)})
    ignored, line = child.communicate()[0].splitlines()
    assert int(ignored.split()[1], 16) == 0 and line == f"{child.pid} check a file" and child.returncode == 3
