"""Starts hang_node: ros2 launch hangpose_ros hang_node.launch.py object_file:=mug.obj supporter:=/camera/points"""

import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    config = os.path.join(get_package_share_directory("hangpose_ros"), "config", "hang_node.yaml")
    return LaunchDescription([
        DeclareLaunchArgument("config", default_value=config, description="file of parameters"),
        DeclareLaunchArgument("object_file", default_value="", description="mesh of the object, an OBJ file"),
        DeclareLaunchArgument("frame", default_value="", description="frame of the poses; empty: that of the cloud"),
        DeclareLaunchArgument("supporter", default_value="supporter", description="topic of the cloud"),
        DeclareLaunchArgument("object", default_value="object", description="topic of the mesh of the object"),
        Node(
            package="hangpose_ros",
            executable="hang_node",
            name="hang_node",
            output="screen",
            parameters=[
                LaunchConfiguration("config"),
                # As text, whatever it looks like.
                {
                    name: ParameterValue(LaunchConfiguration(name), value_type=str)
                    for name in ("object_file", "frame")
                },
            ],
            remappings=[
                ("supporter", LaunchConfiguration("supporter")),
                ("object", LaunchConfiguration("object")),
            ],
        ),
    ])
